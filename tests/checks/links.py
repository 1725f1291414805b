"""Links in Markdown lead to files and headings that exist, and so do mentions of docs/*.md and
scripts/* in any file. The index docs/README.md links every page of docs/."""

import posixpath
import re

from tree import report

LINK = re.compile(r"\]\(([^)\s]+)\)")
MENTION = re.compile(r"(?<![\w/.-])((?:docs/(?:\w+/)*\w+\.md)|(?:scripts/[\w-]+(?:\.txt|\.py)?))(?![\w/*])")
INDEX = "docs/README.md"


def check(tree):
    yield from unlisted(tree)
    for name in tree.texts():
        for number, line in tree.lines(name):
            if name.endswith(".md"):
                for target in LINK.findall(line):
                    yield from broken(tree, name, number, target)
                line = LINK.sub("", line)
            for target in MENTION.findall(line):
                if target not in tree.files:
                    yield f"{name}:{number}: {target} does not exist"


def unlisted(tree):
    if INDEX not in tree.files:
        return
    listed = {f"docs/{target}" for target in LINK.findall(tree.text(INDEX))}
    for name in tree.ending(".md"):
        if name.startswith("docs/") and name != INDEX and name not in listed:
            yield f"{INDEX}: no link to {name}; say in one line whom it serves"


def broken(tree, name, number, target):
    if re.match(r"\w+:", target):
        return
    path, _, anchor = target.partition("#")
    file = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
    if not (tree.root / file).exists():
        yield f"{name}:{number}: the link leads to {file}, which does not exist"
    elif anchor and anchor not in anchors(tree, file):
        yield f"{name}:{number}: {file} has no heading #{anchor}"


def anchors(tree, file):
    """Headings as GitHub spells them in a link."""
    headings = re.findall(r"^#+ +(.*)$", tree.text(file), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


if __name__ == "__main__":
    report(check)
