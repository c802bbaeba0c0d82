// LD_PRELOAD library that simulates a disk that is slow or that fails at a chosen call.
//   FAULT_CALL=write FAULT_AT=3 FAULT_ERRNO=28   the third write to a file and all later ones fail
//   FAULT_DELAY_US=5000                          delays every write, fsync and rename
//   FAULT_READ_DELAY_US=1000                     delays every read
//   FAULT_READ_BYTES=4096                        limits the bytes that a read returns
// Standard streams and files under /proc and /sys are left alone.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/vfs.h>
#include <unistd.h>

static long setting(const char* name, long otherwise) {
  const char* text = getenv(name);
  return text ? strtol(text, NULL, 10) : otherwise;
}

static int left_alone(int file) {
  struct statfs info;
  const long proc = 0x9fa0, sysfs = 0x62656572;
  return file <= STDERR_FILENO || fstatfs(file, &info) != 0 || info.f_type == proc || info.f_type == sysfs;
}

static int fails(const char* call, const char* delay) {
  static atomic_long calls;
  usleep((useconds_t)setting(delay, 0));
  const char* chosen = getenv("FAULT_CALL");
  if (!chosen || strcmp(chosen, call) != 0) return 0;
  if (atomic_fetch_add(&calls, 1) + 1 < setting("FAULT_AT", 1)) return 0;
  errno = (int)setting("FAULT_ERRNO", EIO);
  return 1;
}

ssize_t write(int file, const void* bytes, size_t count) {
  ssize_t (*const real)(int, const void*, size_t) = dlsym(RTLD_NEXT, "write");
  if (!left_alone(file) && fails("write", "FAULT_DELAY_US")) return -1;
  return real(file, bytes, count);
}

ssize_t read(int file, void* bytes, size_t count) {
  ssize_t (*const real)(int, void*, size_t) = dlsym(RTLD_NEXT, "read");
  if (left_alone(file)) return real(file, bytes, count);
  if (fails("read", "FAULT_READ_DELAY_US")) return -1;
  const size_t most = (size_t)setting("FAULT_READ_BYTES", 1 << 30);
  return real(file, bytes, count < most ? count : most);
}

int fsync(int file) {
  int (*const real)(int) = dlsym(RTLD_NEXT, "fsync");
  return fails("fsync", "FAULT_DELAY_US") ? -1 : real(file);
}

int rename(const char* from, const char* to) {
  int (*const real)(const char*, const char*) = dlsym(RTLD_NEXT, "rename");
  return fails("rename", "FAULT_DELAY_US") ? -1 : real(from, to);
}
