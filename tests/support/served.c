/* Preloaded by tests: the program is loaded once and waits before main() at the socket SERVED_SOCKET; each call is a
   fork of it, which runs main() with the arguments, folder, environment, standard streams and limits of the call. Most
   of the time of a small command is the loading of its hundred libraries. Components that MPI has loaded when PETSc is
   ready are loaded for later calls too, and not started. Used by tests/support/served.py. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

/* What a call begins with; then follow the folder, the arguments and the environment, each text with its zero byte. */
struct head {
  uint32_t size, num_arguments, num_variables;
  int32_t limited; /* a resource of setrlimit, or -1 */
  uint64_t limit;
};
enum { STREAMS = 3 };

static int (*main_of_program)(int, char**, char**);

static int read_all(int from, void* to, size_t size) {
  for (size_t at = 0; at < size;) {
    const ssize_t n = read(from, (char*)to + at, size - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return 0;
    at += (size_t)n;
  }
  return 1;
}

/* The head and the three streams that come with its first byte. */
static int receive(int from, struct head* head, int* streams) {
  char room[CMSG_SPACE(STREAMS * sizeof(int))];
  struct iovec part = {head, sizeof *head};
  struct msghdr message = {.msg_iov = &part, .msg_iovlen = 1, .msg_control = room, .msg_controllen = sizeof room};
  const ssize_t n = recvmsg(from, &message, MSG_CMSG_CLOEXEC);
  const struct cmsghdr* with = n > 0 ? CMSG_FIRSTHDR(&message) : NULL;
  if (!with) return 0;
  memcpy(streams, CMSG_DATA(with), STREAMS * sizeof(int));
  return read_all(from, (char*)head + n, sizeof *head - (size_t)n);
}

static char** list_texts(char** at, uint32_t count) {
  char** list = calloc(count + 1, sizeof *list);
  for (uint32_t i = 0; i < count; ++i, *at += strlen(*at) + 1) list[i] = *at;
  return list;
}

static int components[2] = {-1, -1}; /* a pipe from calls to the program that waits */

static int write_component(struct dl_phdr_info* library, size_t size, void* data) {
  (void)size, (void)data;
  if (strstr(library->dlpi_name, "/mca_") || strstr(library->dlpi_name, "/hwloc_"))
    dprintf(components[1], "%s\n", library->dlpi_name);
  return 0;
}

int PetscInitialize(int* argc, char*** argv, const char* file, const char* help) {
  int (*next)(int*, char***, const char*, const char*) =
      (int (*)(int*, char***, const char*, const char*))dlsym(RTLD_NEXT, "PetscInitialize");
  const int code = next(argc, argv, file, help);
  if (components[1] >= 0) dl_iterate_phdr(write_component, NULL);
  return code;
}

/* Loads what the first call that started MPI has written to the pipe. */
static void load_components(void) {
  char text[1 << 14];
  const ssize_t size = read(components[0], text, sizeof text - 1);
  if (size <= 0) return;
  text[size] = 0;
  for (char *at = text, *end; (end = strchr(at, '\n')); at = end + 1) {
    *end = 0;
    dlopen(at, RTLD_LAZY | RTLD_LOCAL);
  }
  close(components[1]);
  components[1] = -1;
}

static void fail(const char* what) {
  perror(what);
  _exit(120);
}

static int serve(int count, char** arguments, char** variables) {
  const int at = atoi(getenv("SERVED_SOCKET"));
  struct head head;
  int streams[STREAMS];
  (void)count, (void)arguments, (void)variables;
  if (pipe2(components, O_CLOEXEC | O_NONBLOCK) != 0) fail("pipe2");
  while (receive(at, &head, streams)) {
    char* text = malloc(head.size);
    int32_t answer = 0;
    if (!text || !read_all(at, text, head.size)) break;
    const pid_t child = fork();
    if (child == 0) {
      char* next = text + strlen(text) + 1;
      char** words = list_texts(&next, head.num_arguments);
      for (int i = 0; i < STREAMS; ++i)
        if (dup2(streams[i], i) < 0) fail("dup2");
      for (int i = 0; i < STREAMS; ++i) close(streams[i]);
      close(at);
      environ = list_texts(&next, head.num_variables);
      const struct rlimit limit = {head.limit, head.limit};
      if (chdir(text) != 0) fail(text);
      if (head.limited >= 0 && setrlimit((__rlimit_resource_t)head.limited, &limit) != 0) fail("setrlimit");
      return main_of_program((int)head.num_arguments, words, environ);
    }
    answer = child;
    if (write(at, &answer, sizeof answer) != sizeof answer) break;
    while (waitpid(child, &answer, 0) < 0 && errno == EINTR) continue;
    for (int i = 0; i < STREAMS; ++i) close(streams[i]);
    free(text);
    load_components();
    if (write(at, &answer, sizeof answer) != sizeof answer) break;
  }
  _exit(0);
}

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void* stack_end) {
  __typeof__(__libc_start_main)* next = (__typeof__(__libc_start_main)*)dlsym(RTLD_NEXT, "__libc_start_main");
  main_of_program = main;
  return next(getenv("SERVED_SOCKET") ? serve : main, argc, argv, init, fini, rtld_fini, stack_end);
}
