"""boot.py PROGRAM [ARGUMENT ...]: boots Debian's kernel in QEMU, without KVM, and runs PROGRAM, a path
of the host, in it. Ends with its exit code, or with 77 and the reason where there is no QEMU or no
kernel to be had."""

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from initramfs import initramfs
from kernel import Unavailable, unpacked_kernel

SKIPPED = 77
QEMU = "qemu-system-x86_64"
# q35: microvm boots faster, but now and then hangs when it calibrates its clock.
MACHINE = ["-accel", "tcg,thread=multi", "-cpu", "max", "-smp", "2", "-m", "1024", "-machine", "q35",
           "-nographic", "-nodefaults", "-no-reboot", "-serial", "stdio", "-nic", "none",
           "-vga", "none"]
LIMIT_S = 540
UDEV = Path("/lib/systemd/systemd-udevd")  # the payload's


def shared(tag, folder, *options):
    """A folder of the host, as QEMU offers it over virtio-9p."""
    local = ",".join([f"local,id={tag},path={folder},security_model=none", *options])
    return ["-fsdev", local, "-device", f"virtio-9p-pci,fsdev={tag},mount_tag={tag}"]


def boot(program, work):
    """The exit code of `program`, a list of words."""
    if shutil.which(QEMU) is None:
        raise Unavailable(f"{QEMU} is not installed")
    if not UDEV.is_file():
        raise Unavailable("udev is not installed")
    kernel = unpacked_kernel()
    image = work / "initramfs"
    image.write_bytes(initramfs(kernel))
    out = work / "out"
    out.mkdir()
    (out / "payload").write_text(f"exec {shlex.join(program)}\n")
    command = ["nice", QEMU, *MACHINE, "-kernel", kernel / "vmlinux", "-initrd", image,
               *shared("root", "/", "readonly=on", "multidevs=remap"), *shared("out", out),
               # On a busy host the emulated timer is late, which Linux takes for a broken board.
               "-append", "console=ttyS0 panic=-1 quiet nokaslr mitigations=off no_timer_check"]
    print(f"booting {kernel.name}", flush=True)
    try:
        subprocess.run(command, stdin=subprocess.DEVNULL, timeout=LIMIT_S, check=False)
    except subprocess.TimeoutExpired:
        print(f"the virtual machine did not end within {LIMIT_S} s")
        return 1
    status = out / "status"
    if not status.is_file():
        print("the virtual machine ended before its program did")
        return 1
    return int(status.read_text())


def main():
    with tempfile.TemporaryDirectory() as work:
        return boot([os.path.abspath(sys.argv[1]), *sys.argv[2:]], Path(work))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Unavailable as reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
