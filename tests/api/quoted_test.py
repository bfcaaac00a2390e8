#!/usr/bin/env python3
"""docs/api.md shows the program that is compiled and run as a test.  Arguments: the page, the program."""
import sys

page, program = (open(path, encoding="utf-8").read() for path in sys.argv[1:3])
same = "```c\n" + program + "```\n" in page
print("1..1")
print(("ok" if same else "not ok") + " 1 - the page shows the program that is run")
sys.exit(not same)
