"""What may be asked of a system beside its motion, one room a question."""
