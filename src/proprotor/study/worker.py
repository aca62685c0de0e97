"""What a worker process does: it analyses batches for a study.

The process reads pickled messages from its standard input and answers each on its standard output: an `Analysis` for
all batches that follow is answered by None, a batch by its variables. An exception is an answer too. The process ends
with its input, so that it never outlives the study.
"""

from __future__ import annotations

import os
import pickle
import signal
import struct
import sys
import traceback
from typing import IO, Any

_LENGTH = struct.Struct("<Q")


def send(stream: IO[bytes], message: Any) -> None:
    """Write one message."""
    content = pickle.dumps(message, protocol=pickle.HIGHEST_PROTOCOL)
    stream.write(_LENGTH.pack(len(content)))
    stream.write(content)
    stream.flush()


def receive(stream: IO[bytes]) -> Any:
    """Return the next message.

    Raises
    ------
    EOFError
        When the other side has ended.
    """
    (length,) = _LENGTH.unpack(_read(stream, _LENGTH.size))
    return pickle.loads(_read(stream, length))


def _read(stream: IO[bytes], length: int) -> bytes:
    content = stream.read(length)
    if len(content) < length:
        raise EOFError
    return content


def main() -> None:
    """Answer messages until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the study ends its workers
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # prints of other code must not get among the answers
    analysis: Any = None
    while True:
        try:
            message = receive(sys.stdin.buffer)
        except EOFError:
            return
        except Exception as error:  # the message cannot be loaded in this process
            answer: Any = error
        else:
            try:
                analysis, answer = (message, None) if callable(message) else (analysis, analysis(message))
            except Exception as error:
                error.add_note(traceback.format_exc())  # a traceback itself cannot be sent
                answer = error
        try:
            send(answers, answer)
        except BrokenPipeError:
            return
        except Exception as error:  # an exception that cannot be sent
            send(answers, RuntimeError(f"{type(answer).__name__}: {answer} ({error})"))
