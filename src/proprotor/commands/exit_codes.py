"""What the exit code of a command means, as the end of each help text."""

EXIT_CODES = """\b
Exit codes:
  0  done; unstable modes and single speeds that fail are results
  1  no speed could be analysed, or an output could not be written
  2  an input cannot be used: the message says which and why
  130  interrupted (Ctrl-C)"""
