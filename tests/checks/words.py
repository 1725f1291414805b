"""Words that must not occur: paths of one machine and hosts of one network anywhere; vague names and
constructs whose bits differ from machine to machine in C++ sources and the build."""

import re

from tree import report

MACHINE_PATH = re.compile(r"(?<![\w.$}/-])/(?:home|root|work|mnt|media|srv|opt|Users)/\w+")
ADDRESS = re.compile(r"\bhttps?://([\w.-]+)")
HOSTS = {"www.apache.org", "www.genicam.org", "doi.org", "arxiv.org",
         # name spaces of SVG, of Debian's copyright files and of OME-XML
         "www.w3.org", "www.debian.org", "www.openmicroscopy.org"}
VAGUE = r"(?:manager|helper|util(?:s|ity|ities)?|base)"
BANNED = (  # pattern, why; in the sources and the build of the modules
    (re.compile(rf"\b(?:class|struct|enum|union) +(?:class +)?\w*{VAGUE}\b", re.I), "a vague name"),
    (re.compile(r"std::\w+_distribution\b"), "the standard does not fix its results"),
    (re.compile(r"-f(?:fast-math|associative-math|p-contract=fast)"), "bits would differ"),
    (re.compile(r"#\s*include <(?:format|expected|coroutine)>"), "not in both compilers"),
)
# A message of a library names a Parameter, which each interface words its own way (core/message.h).
OPTION = re.compile(r'"(?:[^"\\]|\\.)*?(?<![\w-])--[a-z][\w-]*')
COMMANDS = {"readout/provenance.cpp", "study/explore/point_commands.cpp",  # commands to run again
            "study/report/chart.cpp", "capture/v4l2/v4l2_listing.cpp"}  # of other programs
VAGUE_FILE = re.compile(rf"(?:^|[/_]){VAGUE}\.\w+$", re.I)


def check(tree):
    for name in tree.texts():
        if VAGUE_FILE.search(name):
            yield f"{name}: a vague name; say what is in it"
        for number, line in tree.lines(name):
            path = MACHINE_PATH.search(line)
            if path:
                yield f"{name}:{number}: {path[0]}: an absolute path of one machine"
            for host in ADDRESS.findall(line):
                if host not in HOSTS:
                    yield f"{name}:{number}: {host}: not among the hosts of tests/checks/words.py"
    for name in tree.of_modules(".h", ".cpp") + tree.ending("CMakeLists.txt", ".cmake"):
        for number, line in tree.lines(name):
            for pattern, why in BANNED:
                for found in pattern.findall(line):
                    yield f"{name}:{number}: {found}: {why}"
            if OPTION.search(line.partition("//")[0]) and not name.startswith("apps/") and name not in COMMANDS:
                yield f"{name}:{number}: an option of the command line; name a Parameter"


if __name__ == "__main__":
    report(check)
