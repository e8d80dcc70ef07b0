/* Preloaded by tests: at the POINT_COUNT-th call (default 1) of POINT_CALL whose path contains POINT_PATH, holds the
   process (POINT_ACT=hold, the pipe is POINT_PIPE), ends it (exit, code 99), kills it (kill), or at every such call
   appends a line "PID PATH RESIDENT" to POINT_PIPE (log, RESIDENT in kB). */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/syscall.h>

#include "hold.h"

static long get_resident(void) {
  char text[256];
  long size = 0, resident = 0;
  const int from = (int)syscall(SYS_openat, AT_FDCWD, "/proc/self/statm", O_RDONLY);
  const ssize_t n = from < 0 ? 0 : read(from, text, sizeof text - 1);
  if (from >= 0) close(from);
  text[n > 0 ? n : 0] = 0;
  sscanf(text, "%ld %ld", &size, &resident);
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

static void reach(const char* call, const char* path) {
  static volatile int count = 0;
  const char *at = getenv("POINT_CALL"), *part = getenv("POINT_PATH"), *act = getenv("POINT_ACT");
  const char *nth = getenv("POINT_COUNT"), *pipe = getenv("POINT_PIPE");
  if (!at || strcmp(at, call) != 0 || !act) return;
  if (part && (!path || !strstr(path, part))) return;
  if (strcmp(act, "log") == 0) {
    char line[4200];
    const int to = (int)syscall(SYS_openat, AT_FDCWD, pipe, O_WRONLY | O_APPEND | O_CREAT, 0666);
    snprintf(line, sizeof line, "%d %s %ld\n", (int)getpid(), path ? path : "-", get_resident());
    if (to < 0) return;
    if (write(to, line, strlen(line)) < 0) perror(pipe);
    close(to);
    return;
  }
  if (__sync_add_and_fetch(&count, 1) != (nth ? atoi(nth) : 1)) return;
  if (strcmp(act, "exit") == 0) syscall(SYS_exit_group, 99);
  if (strcmp(act, "kill") == 0) kill(getpid(), SIGKILL);
  if (strcmp(act, "hold") == 0) hold(pipe);
}

#define NEXT(name) static __typeof__(name)* next; if (!next) next = (__typeof__(name)*)dlsym(RTLD_NEXT, #name)

int rename(const char* from, const char* to) {
  int result;
  NEXT(rename);
  result = next(from, to);
  reach("rename", to);
  return result;
}
int open(const char* path, int flags, ...) {
  int result;
  mode_t mode = 0;
  NEXT(open);
  if (flags & (O_CREAT | O_TMPFILE)) {
    va_list more;
    va_start(more, flags);
    mode = va_arg(more, mode_t);
    va_end(more);
  }
  result = next(path, flags, mode);
  reach("open", path);
  return result;
}
int PetscInitialize(int* argc, char*** argv, const char* file, const char* help) {
  static int (*next)(int*, char***, const char*, const char*);
  if (!next) next = (int (*)(int*, char***, const char*, const char*))dlsym(RTLD_NEXT, "PetscInitialize");
  reach("PetscInitialize", NULL);
  return next(argc, argv, file, help);
}
int MPI_Init_thread(int* argc, char*** argv, int required, int* provided) {
  static int (*next)(int*, char***, int, int*);
  if (!next) next = (int (*)(int*, char***, int, int*))dlsym(RTLD_NEXT, "MPI_Init_thread");
  reach("MPI_Init", NULL);
  return next(argc, argv, required, provided);
}
int MPI_Allreduce(const void* from, void* to, int count, void* type, void* op, void* comm) {
  static int (*next)(const void*, void*, int, void*, void*, void*);
  static int (*get_size)(void*, int*);
  const char* ranks = getenv("OMPI_COMM_WORLD_SIZE");
  int size = 0;
  if (!next) next = (int (*)(const void*, void*, int, void*, void*, void*))dlsym(RTLD_NEXT, "MPI_Allreduce");
  if (!get_size) get_size = (int (*)(void*, int*))dlsym(RTLD_NEXT, "MPI_Comm_size");
  /* Those of all ranks, which every rank counts alike. */
  if (get_size(comm, &size) == 0 && size == (ranks ? atoi(ranks) : 1)) reach("MPI_Allreduce", NULL);
  return next(from, to, count, type, op, comm);
}
