"""Which numbers of a scenario a measured track tells, and how well."""
