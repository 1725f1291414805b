"""test_summary.py FOLDER: counts the test cases of the results (JUnit XML) in FOLDER, ctest.xml and one
NAME.xml for each GoogleTest program or case that ctest ran as NAME, and names the skipped ones with the
reason."""

import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree


def cases(folder):
    """The reason for skipping it, or None, for each case that was run or skipped."""
    files = {file.relative_to(folder).with_suffix("").as_posix(): file for file in folder.rglob("*.xml")}
    for name, file in files.items():
        for case in ElementTree.parse(file).iter("testcase"):
            skipped = case.find("skipped")
            counted_elsewhere = name == "ctest" and case.get("name") in files
            filtered_out = name != "ctest" and case.get("status") == "notrun"
            if not counted_elsewhere and not filtered_out:
                yield None if skipped is None else reason(skipped.get("message") or "")


def reason(message):
    """GoogleTest puts the place in the source before it."""
    return " ".join(line for line in message.splitlines() if not line.startswith("/"))


def main(folder):
    reasons = list(cases(Path(folder)))
    skipped = Counter(why for why in reasons if why is not None)
    print(f"{len(reasons)} test cases, {sum(skipped.values())} skipped")
    for why, count in skipped.most_common():
        print(f"  {count} skipped: {why}")


if __name__ == "__main__":
    main(sys.argv[1])
