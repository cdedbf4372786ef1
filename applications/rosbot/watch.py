"""What a search has found so far, kept beside it, so that ending it early loses nothing."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from threading import Event

from applications.rosbot.swarms import Callback
from gpsynth.law import Law
from gpsynth.planning import Plan


@dataclass(frozen=True, eq=False)
class Watch:
    """The best plan of every swarm after its latest round, and whether the swarms are to end."""

    callback: Callback | None = None
    latest: dict[object, tuple[Plan, Law]] = field(default_factory=dict)
    stopped: Event = field(default_factory=Event)

    @property
    def is_stopped(self) -> bool:
        """Whether Ctrl-C has been seen."""
        return self.stopped.is_set()

    def of(self, law: Law) -> Callback:
        """The callback of one swarm; after Ctrl-C it ends the swarm."""
        swarm = object()

        def note(plan: Plan) -> bool:
            self.latest[swarm] = (plan, law)
            is_enough = self.callback is not None and bool(self.callback(plan))
            return is_enough or self.is_stopped

        return note

    @contextmanager
    def keeping(self, pool: ThreadPoolExecutor) -> Iterator[None]:
        """Ctrl-C ends what runs in the pool at its next round, and what waits there at once, and goes no further."""
        try:
            yield
        except KeyboardInterrupt:
            self.stopped.set()
            pool.shutdown(cancel_futures=True)
