"""What holds for all tests."""

import signal

# A shell ignores Ctrl-C in what it starts in the background, `make test &`; the tests raise it themselves.
signal.signal(signal.SIGINT, signal.default_int_handler)
