/* Preloaded by tools/trials.py: counts what goes to regular files; in the n-th the process dies, or from it on the
   disk fails. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
static long count = 0;
/* Files of the disk, not those that live in memory. */
static int is_file(int fd) {
  struct stat s;
  char link[40], name[16];
  if (fstat(fd, &s) != 0 || !S_ISREG(s.st_mode)) return 0;
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, name, sizeof name);
  return !(n >= 7 && !strncmp(name, "/memfd:", 7));
}
/* 1: fail; 2: write half, then die */
static int check(void) {
  const char* at = getenv("TRIAL_AT");
  const char* log = getenv("TRIAL_LOG");
  const long n = at ? atol(at) : 0;
  ++count;
  if (log) { FILE* f = fopen(log, "w"); if (f) { fprintf(f, "%ld", count); fflush(NULL); } }
  if (n == 0 || count < n) return 0;
  const char* error = getenv("TRIAL_ERROR");
  if (error) { errno = atoi(error); return 1; }
  return count == n ? 2 : 0;
}
#define NEXT(name) static __typeof__(name)* next; if (!next) next = dlsym(RTLD_NEXT, #name)
#define DIE() do { kill(getpid(), SIGKILL); pause(); } while (0)
static int in_log = 0;
static int judge(int fd) {
  if (in_log || !is_file(fd)) return 0;
  in_log = 1;
  const int j = check();
  in_log = 0;
  return j;
}
ssize_t write(int fd, const void* b, size_t n) {
  NEXT(write);
  const int j = judge(fd);
  if (j == 1) return -1;
  if (j == 2) { next(fd, b, n / 2); DIE(); }
  return next(fd, b, n);
}
#define WRITE_AT(name, offset)                              \
  ssize_t name(int fd, const void* b, size_t n, offset o) { \
    NEXT(name);                                             \
    const int j = judge(fd);                                \
    if (j == 1) return -1;                                  \
    if (j == 2) { next(fd, b, n / 2, o); DIE(); }           \
    return next(fd, b, n, o);                               \
  }
WRITE_AT(pwrite, off_t)
WRITE_AT(pwrite64, off64_t)
ssize_t writev(int fd, const struct iovec* v, int n) {
  NEXT(writev);
  const int j = judge(fd);
  if (j == 1) return -1;
  if (j == 2) DIE();
  return next(fd, v, n);
}
int fsync(int fd) {
  NEXT(fsync);
  const int j = judge(fd);
  if (j == 1) return -1;
  if (j == 2) DIE();
  return next(fd);
}
int rename(const char* a, const char* b) {
  NEXT(rename);
  const int j = in_log ? 0 : check();
  if (j == 1) return -1;
  if (j == 2) DIE();
  return next(a, b);
}
