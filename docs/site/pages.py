"""Gathers the pages of the site in one folder: those of the project as they are, and one for each C++ header."""

import re
import shutil
import subprocess
from pathlib import Path

LINK = re.compile(r"\[([^\]]*)\]\(([^)\s#]+)((?:#[^)\s]*)?)\)")
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "docs/*.md", "docs/notes/*.md")
INCLUDE = re.compile(r'^#include "(?!stipple/)([^"]+)"', re.M)


def gather(root, target):
    """Copies the pages of the project to the folder `target`, and all files that they link to."""
    for pattern in PAGES:
        for page in root.glob(pattern):
            place = target / page.relative_to(root)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(with_files(page, root, target))
    for page in (root / "docs/site").glob("*.rst"):
        shutil.copy(page, target)
    (target / "_static").mkdir()
    shutil.copy(root / "docs/site/stipple.css", target / "_static")
    shutil.copy(root / "docs/site/conf.py", target)
    shutil.copytree(root / "docs/figures", target / "docs/figures", dirs_exist_ok=True)
    write_cpp_pages(root, target / "cpp")


def with_files(page, root, target):
    """The text of a page. A site has no folders to look into, so a link to a folder becomes plain text."""

    def link(match):
        if re.match(r"\w+:", match[2]):
            return match[0]
        linked = (page.parent / match[2]).resolve()
        if linked.is_dir():
            return match[1]
        place = target / linked.relative_to(root)
        if linked.suffix != ".md" and linked.is_file() and not place.exists():
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(linked, place)
        return match[0]

    return LINK.sub(link, page.read_text())


def write_command_line(program, page):
    """The options of all commands, as the program lists them."""
    folder = page.with_suffix("")
    subprocess.run([program, "manual", folder, "--markdown"], check=True)
    texts = (f"## {file.stem.replace('-', ' ')}\n\n{file.read_text()}"
             for file in sorted(folder.iterdir(), key=lambda file: file.stem))
    page.write_text("\n".join(("# Command line\n", *texts)))
    shutil.rmtree(folder)


def write_cpp_pages(root, folder):
    """A page for each header of stipple/, with the interfaces that it includes."""
    folder.mkdir()
    for header in (root / "stipple").glob("*.h"):
        title = f"<stipple/{header.name}>"
        text = header.read_text()
        comment = [line[1:] for line in re.findall(r"^///( .*|)$", text, re.M)]
        code = [line for line in comment if line.startswith("    ")]
        words = " ".join(line for line in comment[:comment.index(code[0])] if line)
        lines = [title, "=" * len(title), "", words.rstrip(":"), "", ".. code-block:: cpp", "", *code, ""]
        for included in INCLUDE.findall(text):
            lines += [included, "-" * len(included), "", f".. doxygenfile:: {included}", ""]
        (folder / f"{header.stem}.rst").write_text("\n".join(lines))


def doxygen_configuration(root, output):
    """For doxygen's standard input: XML of all headers."""
    included = {name.split("/")[0] for header in (root / "stipple").glob("*.h")
                for name in INCLUDE.findall(header.read_text())}
    folders = " ".join(str(root / module) for module in sorted(included))
    return "\n".join((
        "PROJECT_NAME = Stipple", f"INPUT = {folders}", "FILE_PATTERNS = *.h", "RECURSIVE = YES",
        "EXCLUDE_PATTERNS = *-inl.h", f"OUTPUT_DIRECTORY = {output}", "INCLUDE_GRAPH = NO",
        "INCLUDED_BY_GRAPH = NO", "GENERATE_HTML = NO", "GENERATE_LATEX = NO", "GENERATE_XML = YES",
        "XML_PROGRAMLISTING = NO", f"STRIP_FROM_PATH = {root}", "EXTRACT_ALL = YES",
        "HIDE_FRIEND_COMPOUNDS = YES", "QUIET = YES", "WARNINGS = NO",
        f'INPUT_FILTER = "sed -E -f {root / "docs/site/header_filter.sed"}"', ""))
