"""Debian's generic kernel, unpacked in a cache folder outside the tree: the one with the vivid driver
(the cloud kernel has no media drivers)."""

import lzma
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

PACKAGE = "linux-image-amd64"  # depends on the kernel of the day


class Unavailable(Exception):
    """Why there is no kernel to be had: the reason for which tests are skipped."""


def cache_folder():
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(cache) / "stipple" / "vm"


def unpacked_kernel():
    """The folder of a kernel: vmlinux, and lib/modules/VERSION with its module index. Downloads 70 MB
    the first time; what is in the cache is used from then on, with or without a network."""
    cache = cache_folder()
    ready = sorted(cache.glob("kernel-*"), key=lambda folder: folder.stat().st_mtime)
    return ready[-1] if ready else fetch(cache)


def fetch(cache):
    version = newest_version()
    try:
        cache.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=cache, prefix="fetch-") as work:
            work = Path(work)
            run(["apt-get", "download", f"linux-image-{version}"], work)
            package, = work.glob("*.deb")
            unpacked = work / "kernel"
            run(["dpkg", "-x", package, unpacked], work)
            run(["/usr/sbin/depmod", "-b", unpacked, version], work)
            image = unpacked / "boot" / f"vmlinuz-{version}"
            (unpacked / "vmlinux").write_bytes(uncompressed(image.read_bytes()))
            shutil.rmtree(unpacked / "boot")
            final = cache / f"kernel-{version}"
            try:
                unpacked.rename(final)  # only what is complete gets its name
            except OSError:
                if not final.is_dir():  # else another run was faster
                    raise
            return final
    except OSError as error:
        raise Unavailable(f"cannot unpack the kernel: {error}") from error


def newest_version():
    known = run(["apt-cache", "depends", PACKAGE])
    found = re.search(r"Depends: linux-image-(\S+)", known)
    if not found:
        raise Unavailable(f"apt knows no {PACKAGE}; apt-get update may help")
    return found[1]


def run(command, folder=None):
    try:
        done = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True,
                              timeout=300)
    except FileNotFoundError as error:
        raise Unavailable(f"{command[0]} is not installed") from error
    except subprocess.TimeoutExpired as error:
        raise Unavailable(f"{' '.join(map(str, command))}: no answer") from error
    except subprocess.CalledProcessError as error:
        last = (error.stderr.strip() or "failed").splitlines()[-1]
        raise Unavailable(f"{' '.join(map(str, command))}: {last}") from error
    return done.stdout


def uncompressed(image):
    """The vmlinux inside a vmlinuz, an xz stream somewhere in it: QEMU boots it directly (PVH), which
    spares its own, emulated decompression."""
    start = image.find(b"\xfd7zXZ\0")
    if start < 0:
        raise Unavailable("the kernel is not compressed with xz")
    return lzma.LZMADecompressor().decompress(image[start:])


def modules_with_dependencies(kernel, names):
    """Files of the modules, in the order in which they are to be loaded."""
    version = kernel.name.removeprefix("kernel-")
    files = []
    for name in names:
        listed = run(["/usr/sbin/modprobe", "-d", kernel, "-S", version, "--show-depends", name])
        files += [line.split()[1] for line in listed.splitlines() if line.startswith("insmod ")]
    return [Path(file) for file in dict.fromkeys(files)]
