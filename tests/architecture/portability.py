"""Functions of one system stay in base/platform.hpp and .cpp: everything else calls POSIX and the standard library."""
import re

from common import finish, line_of, list_files, list_sources, read, strip_comments

PLATFORM = ["base/platform.hpp", "base/platform.cpp"]
HEADERS = ["link", "malloc", "sys/prctl", "sys/syscall", "sys/epoll", "sys/eventfd", "sys/inotify", "sys/signalfd",
           "sys/timerfd", "sys/sendfile", "sys/sysinfo", "sched", "features", "immintrin", "x86intrin", "arm_neon",
           "crt_externs", "mach/.*", "mach-o/.*", "malloc/.*", "linux/.*", "asm/.*", "bits/.*", "gnu/.*", "ext/.*"]
# Functions, constants and fields, as words of the code.
NAMES = r"""
prctl syscall memfd_create fdatasync fallocate pipe2 accept4 dup3 getrandom gettid tgkill mremap madvise
sched_\w+ pthread_setaffinity_np epoll_\w+ eventfd inotify_\w+ signalfd timerfd_\w+ sendfile splice copy_file_range
sync_file_range posix_fadvise readahead dl_iterate_phdr mallopt mallinfo2? malloc_trim malloc_usable_size
qsort_r strerror_r strchrnul secure_getenv clearenv mkostemp program_invocation_\w+ canonicalize_file_name ppoll
sigtimedwait sigwaitinfo renameat2 posix_spawn_file_actions_addclosefrom_np environ
SOCK_CLOEXEC SOCK_NONBLOCK MSG_NOSIGNAL O_TMPFILE O_PATH O_DIRECT F_OFD_\w+ F_FULLFSYNC F_PREALLOCATE MADV_\w+
st_[amc]tim st_[amc]timespec
__linux__ __APPLE__ __GLIBC__ __x86_64__ __aarch64__ __builtin_cpu_\w+ _mm\d*_\w+ __m\d+d? _NSGet\w+ kqueue kevent
""".split()
# Files of Linux and sections of ELF, which are no words of the code.
TEXTS = [r'"/proc/', r'"/sys/', r'preinit_array']
# With AVX2 there is a loop in intrinsics next to the portable one.
ALLOWED = {("fe/linear/row_products.cpp", r"<immintrin\.h>|_mm\d*_\w+|__m\d+d?")}

findings = []


def find_real_numbers(text):
    """Calls of std::from_chars with a double or a number of any type, which libc++ has lately only."""
    for match in re.finditer(r"\bfrom_chars\([^;]*?, (\w+)\)", text):
        if re.search(rf"\b(double|float|Number|T)\s*&?\s*\b{match.group(1)}\b", text):
            yield match


sources = [source for source in list_sources() if source not in PLATFORM]
for source in sources + list_files(["embed"], (".h",)):
    text = strip_comments(read(source))
    allowed = [pattern for path, pattern in ALLOWED if path == source]
    patterns = [rf"#\s*include\s*(<(?:{'|'.join(HEADERS)})\.h>)", rf"\b({'|'.join(NAMES)})\b", rf"({'|'.join(TEXTS)})"]
    for pattern in patterns:
        code = text if "include" in pattern or '"/proc' in pattern else re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)
        for match in re.finditer(pattern, code):
            if not any(re.fullmatch(one, match.group(1)) for one in allowed):
                findings.append(f"{source}:{line_of(code, match.start())}: {match.group(1)} belongs into base/platform.cpp")
    for match in find_real_numbers(text):
        findings.append(f"{source}:{line_of(text, match.start())}: read real numbers by platform::read_number")
finish(findings, "portability")
