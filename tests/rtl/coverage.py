"""Prints the lines and toggles of the chip that a run of rtl_test reached. usage: coverage.py COVERAGE.dat"""

import re
import sys
from collections import defaultdict
from pathlib import Path


def points(path):
    """Each point of the sources in all sizes of the chip: (module, line, kind, name), and how often it was reached."""
    counts = defaultdict(int)
    for line in Path(path).read_text(errors="replace").splitlines():
        match = re.match(r"C '(.*)' (\d+)$", line)
        if not match:
            continue
        fields = dict(item.split("\2", 1) for item in match[1].split("\1") if "\2" in item)
        kind = "toggle" if fields["page"].startswith("v_toggle") else "line"
        key = (Path(fields["f"]).stem, int(fields["l"]), kind, fields.get("o", "") if kind == "toggle" else "")
        counts[key] += int(match[2])
    return counts


def main():
    counts = points(sys.argv[1])
    share = defaultdict(lambda: [0, 0])
    for (module, _, kind, _), count in counts.items():
        for name in module, "all":
            share[name, kind][0] += count > 0
            share[name, kind][1] += 1
    print(f"{'module':18} {'lines':>14} {'toggles':>16}")
    for name in [*sorted({module for module, *_ in counts}), "all"]:
        texts = []
        for kind in "line", "toggle":
            reached, of = share[name, kind]
            texts.append(f"{reached:6}/{of:<6} {100 * reached / of:4.0f} %" if of else "")
        print(f"{name:18} {texts[0]:>18} {texts[1]:>20}")
    missed = defaultdict(set)
    for (module, line, kind, name), count in counts.items():
        if count == 0:
            missed[module, line, kind].add(re.sub(r"\[(\d+)\].*", "", name))
    print("not reached:")
    for (module, line, kind), names in sorted(missed.items()):
        print(f"  rtl/{module}.sv:{line} {kind} {' '.join(sorted(names))}")


if __name__ == "__main__":
    main()
