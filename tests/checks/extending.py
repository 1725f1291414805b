"""The diffs of docs/extending.md apply to this tree, and touch no more files than the page says."""

import re
import subprocess

from tree import report

PAGE = "docs/extending.md"
ROW = re.compile(r"^\| [^|]+ \| (\d+) \| \[[\w.]+\]\((extending/\w+\.diff)\)", re.M)


def check(tree):
    if PAGE not in tree.files:
        return
    rows = {f"docs/{diff}": int(files) for files, diff in ROW.findall(tree.text(PAGE))}
    diffs = {name for name in tree.files if re.fullmatch(r"docs/extending/\w+\.diff", name)}
    for name in sorted(diffs ^ rows.keys()):
        yield f"{name}: is not both a file and a row of {PAGE}"
    for name in sorted(diffs & rows.keys()):
        touched = len(re.findall(r"^diff --git ", tree.text(name), re.M))
        if touched != rows[name]:
            yield f"{name}: touches {touched} files, {PAGE} says {rows[name]}"
        applied = subprocess.run(["git", "apply", "--check", str(tree.root / name)], cwd=tree.root,
                                 capture_output=True, text=True)
        if applied.returncode != 0:
            yield f"{name}: does not apply to this tree ({applied.stderr.splitlines()[0]}); make it anew"


if __name__ == "__main__":
    report(check)
