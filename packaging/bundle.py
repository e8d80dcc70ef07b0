"""Relocatable bundles: programs with their libraries, archives that are the same bytes each time, wheels.

packaging/release.py makes the files of a release with it.
"""
import base64
import functools
import gzip
import hashlib
import io
import os
import re
import shutil
import stat
import subprocess
import tarfile
import time
import zipfile

# Of glibc, and so of the system: a program finds the one that its loader belongs to.
GLIBC = re.compile(r"(lib(c|m|dl|pthread|rt|resolv|util|mvec|anl|nsl|BrokenLocale)|ld-linux-x86-64)\.so\.\d+|linux-vdso\.so\.1")
# Of the compiler; manylinux takes these from the system too, so that one process has one of each.
COMPILER = re.compile(r"lib(stdc\+\+|gcc_s)\.so\.\d+")
# What drivers of networks need: a bundle serves one machine, and the drivers belong to the site.
NETWORK = re.compile(r"lib(fabric|ibverbs|rdmacm|efa|ucp|uct|ucs|ucm|psm2|psm_infinipath|infinipath|nl-3|nl-route-3)\.so")


class ReleaseError(Exception):
    pass


def run(*command, **options):
    done = subprocess.run(command, text=True, capture_output=True, **options)
    if done.returncode:
        raise ReleaseError(f"{' '.join(map(str, command))}: {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout


@functools.lru_cache(maxsize=None)
def read_ldd(path, size, changed):
    """What ldd prints of a file of that size and time of change."""
    return run("ldd", path, env={**os.environ, "LC_ALL": "C"})


def list_libraries(paths, is_system):
    """{soname: file} of all libraries that the files load, without those of the system."""
    found = {}
    for path in paths:
        state = os.stat(path)
        for line in read_ldd(path, state.st_size, state.st_mtime_ns).split("\n"):
            match = re.match(r"\s*(\S+) => (\S+)", line)
            if not match or is_system(os.path.basename(match.group(1))):
                continue
            if match.group(2) == "not":
                raise ReleaseError(f"{path}: {match.group(1)} is not found; install what the program was linked to")
            known = found.setdefault(match.group(1), os.path.realpath(match.group(2)))
            if known != os.path.realpath(match.group(2)):
                raise ReleaseError(f"two files of {match.group(1)}: {known} and {match.group(2)}")
    return found


def is_elf(path):
    with open(path, "rb") as f:
        return f.read(4) == b"\x7fELF"


def find_glibc(paths):
    """The newest version of glibc's symbols that the files ask for, as (2, 36)."""
    text = run("readelf", "-W", "--version-info", *paths) if paths else ""
    return max((tuple(map(int, number.split("."))) for number in re.findall(r"Name: GLIBC_(\d+\.\d+)", text)), default=(2, 0))


def copy(source, target):
    os.makedirs(os.path.dirname(target), exist_ok=True)
    shutil.copyfile(source, target)
    os.chmod(target, 0o755 if os.stat(source).st_mode & stat.S_IXUSR and not target.endswith(".so") else 0o644)


def set_path(path, *folders):
    """DT_RPATH by $ORIGIN: unlike DT_RUNPATH it precedes LD_LIBRARY_PATH and serves libraries of libraries."""
    where = ":".join("$ORIGIN" if folder == "." else "$ORIGIN/" + folder for folder in folders)
    os.chmod(path, os.stat(path).st_mode | stat.S_IWUSR)
    run("patchelf", "--force-rpath", "--set-rpath", where, path)


def add_libraries(libraries, folder):
    os.makedirs(folder, exist_ok=True)
    for name, source in sorted(libraries.items()):
        target = os.path.join(folder, name)
        copy(source, target)
        os.chmod(target, 0o644)
        set_path(target, ".")


def list_components(folder, is_system):
    """{file: libraries} of the components of Open MPI or PMIx that need no driver of a network."""
    kept = {}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        if name.endswith(".so") and name.startswith(("mca_", "pmix_mca_")):
            needed = list_libraries([path], is_system)
            if not any(NETWORK.match(library) for library in needed):
                kept[path] = needed
    return kept


def list_files(folder):
    """Paths below a folder, sorted, without folders; symbolic links are listed and not followed."""
    found = []
    for base, folders, names in os.walk(folder):
        names += [name for name in folders if os.path.islink(os.path.join(base, name))]
        found += [os.path.relpath(os.path.join(base, name), folder) for name in names]
    return sorted(found)


def write_tar(folder, output, epoch):
    """A .tar.gz (every system has gzip) of a folder under its name; sorted, owner 0, one time: the same bytes again."""
    top = os.path.basename(folder)
    with open(output, "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=epoch) as packed, \
            tarfile.open(fileobj=packed, mode="w", format=tarfile.GNU_FORMAT) as tar:
        for path in list_files(folder):
            where = os.path.join(folder, path)
            entry = tarfile.TarInfo(f"{top}/{path}")
            entry.mtime = epoch
            if os.path.islink(where):
                entry.type, entry.linkname, entry.mode = tarfile.SYMTYPE, os.readlink(where), 0o777
                tar.addfile(entry)
                continue
            entry.size, entry.mode = os.path.getsize(where), stat.S_IMODE(os.stat(where).st_mode) & 0o755
            with open(where, "rb") as f:
                tar.addfile(entry, f)


def write_wheel(folder, output, epoch):
    """A .whl of a folder, with its RECORD; sorted, one time: the same bytes again."""
    info = next(name for name in os.listdir(folder) if name.endswith(".dist-info"))
    record = f"{info}/RECORD"
    lines = []
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        def add(path, data, mode):
            entry = zipfile.ZipInfo(path, time.gmtime(max(epoch, 315532800))[:6])   # ZIP begins in 1980
            entry.external_attr = (stat.S_IFREG | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
        for path in list_files(folder):
            with open(os.path.join(folder, path), "rb") as f:   # a wheel has no links
                data = f.read()
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            lines.append(f"{path},sha256={digest},{len(data)}")
            add(path, data, 0o755 if os.stat(os.path.join(folder, path)).st_mode & stat.S_IXUSR else 0o644)
        add(record, ("\n".join([*lines, f"{record},,"]) + "\n").encode(), 0o644)


def hash_file(path, kind="sha256"):
    digest = hashlib.new(kind)
    with (io.BytesIO(os.readlink(path).encode()) if os.path.islink(path) else open(path, "rb")) as f:
        for block in iter(lambda: f.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()
