"""The first file system of the virtual machine: busybox, the modules, tests/vm/init."""

import gzip
import shutil
import subprocess
import tempfile
from pathlib import Path

from kernel import Unavailable, modules_with_dependencies

BUSYBOX = Path("/bin/busybox")
AT_BOOT = ("virtio_pci", "9pnet_virtio", "9p")
LATE = ("vivid", "dummy_hcd", "usb_f_fs")  # loaded by the payload, which gives options


def initramfs(kernel):
    """The bytes of a compressed cpio archive."""
    if not BUSYBOX.is_file():
        raise Unavailable("busybox-static is not installed")
    at_boot = modules_with_dependencies(kernel, AT_BOOT)
    late = [file for file in modules_with_dependencies(kernel, LATE) if file not in at_boot]
    with tempfile.TemporaryDirectory() as root:
        root = Path(root)
        for folder in ("bin", "proc", "sys", "dev", "host", "modules/late"):
            (root / folder).mkdir(parents=True)
        shutil.copy(BUSYBOX, root / "bin")
        for file in at_boot:
            shutil.copy(file, root / "modules")
        for file in late:
            shutil.copy(file, root / "modules" / "late")
        (root / "modules" / "order").write_text("".join(f"{file.name}\n" for file in at_boot))
        (root / "modules" / "late" / "order").write_text(
            "".join(f"{file.name}\n" for file in late))
        shutil.copy(Path(__file__).parent / "init", root / "init")
        (root / "init").chmod(0o755)
        names = "\0".join(str(file.relative_to(root)) for file in sorted(root.rglob("*")))
        try:
            packed = subprocess.run(["cpio", "-0", "-o", "-H", "newc", "--quiet"], cwd=root,
                                    input=names.encode(), check=True, capture_output=True)
        except FileNotFoundError as error:
            raise Unavailable("cpio is not installed") from error
    return gzip.compress(packed.stdout, compresslevel=1)
