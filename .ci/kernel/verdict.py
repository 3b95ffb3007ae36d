"""What the guest's tests came to: exits 0 only when every one of them ran and passed, and says how many did."""

import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

AT_LEAST = 12  # tests on the kernel's bus and with its pads; fewer means that some were not found

results = Path(sys.argv[1])
try:
    status = int((results / "status").read_text())
    cases = list(ElementTree.parse(results / "tests.xml").iter("testcase"))
except (OSError, ValueError, ElementTree.ParseError) as error:
    sys.exit(f"tests on a real kernel: the guest left no results: {error}")
outcomes = Counter(next((child.tag for child in case), "passed") for case in cases)
counted = ", ".join(f"{count} {outcome}" for outcome, count in sorted(outcomes.items()))
sys.stdout.write(f"tests on a real kernel: {counted}\n")
if status or set(outcomes) != {"passed"} or len(cases) < AT_LEAST:
    sys.exit(f"tests on a real kernel: all of at least {AT_LEAST} must run and pass (pytest's status was {status})")
