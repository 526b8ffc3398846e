/* The programs bin/weft and bin/weft-tools of the archive. They start libexec/<same name> with the loader and the
 * libraries in lib, a folder beside bin. They are linked statically: the kernel needs the absolute path of a loader,
 * which is not known before the archive is unpacked. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void fail(const char *what, int problem) {
  fprintf(stderr, "weft: %s: %s\n", what, strerror(problem));
  exit(1);
}

static char *join(const char *folder, const char *name) {
  char *path = malloc(strlen(folder) + strlen(name) + 1);
  if (!path) fail("start", errno);
  return strcat(strcpy(path, folder), name);
}

int main(int argc, char **argv) {
  char self[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
  if (length < 0) fail("/proc/self/exe, where this program finds its libraries (is /proc mounted?)", errno);
  self[length] = '\0';

  char *folder = join(self, "");
  char *name = strrchr(folder, '/') + 1;
  const char *program = join("libexec/", name);
  name[-1] = '\0';                /* .../bin */
  strrchr(folder, '/')[1] = '\0'; /* .../ */
  char *loader = join(folder, "lib/ld-linux-x86-64.so.2");
  char *image = join(folder, program);

  /* --argv0 passes the path of this program to the started program (core/installation.cpp). There is no environment
   * variable for this path, because child processes would inherit it. */
  /* $ORIGIN stands for the folder of the program. The loader would take a colon in a written path for a separator. */
  char *options[] = {loader, "--inhibit-cache", "--library-path", "$ORIGIN/../lib", "--argv0", self, image};
  const size_t count = sizeof options / sizeof *options, given = argc > 1 ? (size_t)argc - 1 : 0;
  char **arguments = calloc(count + given + 1, sizeof *arguments);
  if (!arguments) fail("start", errno);
  memcpy(arguments, options, sizeof options);
  if (given) memcpy(arguments + count, argv + 1, given * sizeof *argv);
  execv(loader, arguments);
  fail(join(loader, ", which belongs beside the folder of this program; unpack the archive as a whole"), errno);
}
