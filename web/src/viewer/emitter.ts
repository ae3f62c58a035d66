/** Who is told of what. */
export class Emitter<Events> {
  private readonly listeners = new Map<keyof Events, Set<(event: never) => void>>()

  on<Name extends keyof Events>(name: Name, listener: (event: Events[Name]) => void): () => void {
    const told = this.listeners.get(name) ?? new Set()
    this.listeners.set(name, told)
    told.add(listener as (event: never) => void)
    return () => told.delete(listener as (event: never) => void)
  }

  emit<Name extends keyof Events>(name: Name, event: Events[Name]): void {
    for (const listener of [...(this.listeners.get(name) ?? [])]) (listener as (event: Events[Name]) => void)(event)
  }

  clear(): void {
    this.listeners.clear()
  }
}
