#include "tests/audio_node/support/callback_trap.h"

#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TACTUS_SANITIZED 1
#endif

namespace tactus::audio::test {
namespace {

thread_local int armed = 0;
std::atomic<int> count{0};
std::atomic<const char*> first{nullptr};

// Sanitizers replace the same functions: there the trap counts nothing.
[[maybe_unused]] void count_call(const char* what) {
  if (armed == 0) return;
  count.fetch_add(1, std::memory_order_relaxed);
  const char* none = nullptr;
  first.compare_exchange_strong(none, what);
}

// The next definition of a function after ours. Without a static local, because its guard would be a lock.
template <class F>
[[maybe_unused]] F* next(std::atomic<void*>& kept, const char* name) {
  void* f = kept.load(std::memory_order_relaxed);
  if (!f) {
    // dlsym() may allocate: this belongs to the trap, not to the callback.
    const int before = std::exchange(armed, 0);
    // Conditions have an older symbol of the same name, for another layout; where there is only one, it is the
    // next.
    f = dlvsym(RTLD_NEXT, name, "GLIBC_2.3.2");
    if (!f) f = dlsym(RTLD_NEXT, name);
    armed = before;
    kept.store(f, std::memory_order_relaxed);
  }
  return reinterpret_cast<F*>(f);
}

}  // namespace

Trap::Trap() { ++armed; }
Trap::~Trap() { --armed; }
int trapped() { return count; }
std::string first_trapped() {
  const char* name = first;
  return name ? name : "";
}
void reset_trapped() { count = 0, first = nullptr; }

bool traps_allocation() {
#if defined(TACTUS_SANITIZED)
  return false;
#else
  return true;
#endif
}

}  // namespace tactus::audio::test

using tactus::audio::test::next;
using tactus::audio::test::count_call;

// NOLINTBEGIN: the names and signatures are those of the C library.
#define PASS_ON(result, name, parameters, arguments)       \
  extern "C" result name parameters {                      \
    static std::atomic<void*> kept{nullptr};               \
    count_call(#name);                                           \
    return next<result parameters>(kept, #name) arguments; \
  }

#if !defined(TACTUS_SANITIZED)
// Entry points of glibc: dlsym() itself allocates before it has found the next malloc.
extern "C" {
void* __libc_malloc(std::size_t);
void __libc_free(void*);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  count_call("malloc");
  return __libc_malloc(size);
}
void free(void* p) {
  if (p) count_call("free");
  __libc_free(p);
}
void* calloc(std::size_t n, std::size_t size) {
  count_call("calloc");
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t size) {
  count_call("realloc");
  return __libc_realloc(p, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  count_call("memalign");
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count_call("aligned_alloc");
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  count_call("posix_memalign");
  *p = __libc_memalign(alignment, size);
  return *p ? 0 : ENOMEM;
}
}

PASS_ON(int, pthread_mutex_lock, (pthread_mutex_t * m), (m))
PASS_ON(int, pthread_mutex_trylock, (pthread_mutex_t * m), (m))
PASS_ON(int, pthread_rwlock_rdlock, (pthread_rwlock_t * m), (m))
PASS_ON(int, pthread_rwlock_wrlock, (pthread_rwlock_t * m), (m))
PASS_ON(int, pthread_cond_signal, (pthread_cond_t * c), (c))
PASS_ON(int, pthread_cond_broadcast, (pthread_cond_t * c), (c))
PASS_ON(int, pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m))
PASS_ON(int, pthread_cond_timedwait, (pthread_cond_t * c, pthread_mutex_t* m, const timespec* until),
        (c, m, until))
PASS_ON(int, pthread_cond_clockwait,
        (pthread_cond_t * c, pthread_mutex_t* m, clockid_t clock, const timespec* until), (c, m, clock, until))
PASS_ON(int, sem_wait, (sem_t * s), (s))
PASS_ON(int, sem_post, (sem_t * s), (s))
PASS_ON(ssize_t, read, (int fd, void* p, std::size_t n), (fd, p, n))
PASS_ON(ssize_t, write, (int fd, const void* p, std::size_t n), (fd, p, n))
PASS_ON(ssize_t, pread, (int fd, void* p, std::size_t n, off_t at), (fd, p, n, at))
PASS_ON(ssize_t, pwrite, (int fd, const void* p, std::size_t n, off_t at), (fd, p, n, at))
PASS_ON(ssize_t, writev, (int fd, const iovec* v, int n), (fd, v, n))
PASS_ON(ssize_t, send, (int fd, const void* p, std::size_t n, int flags), (fd, p, n, flags))
PASS_ON(ssize_t, sendto, (int fd, const void* p, std::size_t n, int flags, const sockaddr* to, socklen_t size),
        (fd, p, n, flags, to, size))
PASS_ON(ssize_t, recv, (int fd, void* p, std::size_t n, int flags), (fd, p, n, flags))
PASS_ON(int, close, (int fd), (fd))
PASS_ON(int, poll, (pollfd * fds, nfds_t n, int timeout_ms), (fds, n, timeout_ms))
PASS_ON(int, usleep, (useconds_t us), (us))
PASS_ON(int, nanosleep, (const timespec* t, timespec* left), (t, left))
PASS_ON(int, clock_nanosleep, (clockid_t clock, int flags, const timespec* t, timespec* left),
        (clock, flags, t, left))
PASS_ON(int, sched_yield, (), ())
PASS_ON(std::size_t, fwrite, (const void* p, std::size_t size, std::size_t n, FILE* f), (p, size, n, f))
PASS_ON(int, fflush, (FILE * f), (f))
PASS_ON(int, puts, (const char* text), (text))
PASS_ON(std::size_t, fread, (void* p, std::size_t size, std::size_t n, FILE* f), (p, size, n, f))
PASS_ON(int, munmap, (void* p, std::size_t n), (p, n))
PASS_ON(void*, mmap, (void* p, std::size_t n, int protection, int flags, int fd, off_t at),
        (p, n, protection, flags, fd, at))
PASS_ON(void*, mmap64, (void* p, std::size_t n, int protection, int flags, int fd, off64_t at),
        (p, n, protection, flags, fd, at))
PASS_ON(int, ppoll, (pollfd * fds, nfds_t n, const timespec* t, const sigset_t* mask), (fds, n, t, mask))
PASS_ON(int, select, (int n, fd_set* in, fd_set* out, fd_set* failed, timeval* t), (n, in, out, failed, t))
PASS_ON(int, pselect, (int n, fd_set* in, fd_set* out, fd_set* failed, const timespec* t, const sigset_t* mask),
        (n, in, out, failed, t, mask))
PASS_ON(int, epoll_wait, (int fd, epoll_event* events, int n, int timeout_ms), (fd, events, n, timeout_ms))
PASS_ON(int, epoll_pwait, (int fd, epoll_event* events, int n, int timeout_ms, const sigset_t* mask),
        (fd, events, n, timeout_ms, mask))
PASS_ON(int, sem_timedwait, (sem_t * s, const timespec* until), (s, until))

// Opening a file takes further arguments.
extern "C" int open(const char* path, int flags, ...) {
  static std::atomic<void*> kept{nullptr};
  count_call("open");
  va_list list;
  va_start(list, flags);
  const int mode = va_arg(list, int);
  va_end(list);
  return next<int(const char*, int, ...)>(kept, "open")(path, flags, mode);
}
// ioctl takes further arguments too.
extern "C" int ioctl(int fd, unsigned long request, ...) noexcept {
  static std::atomic<void*> kept{nullptr};
  count_call("ioctl");
  va_list list;
  va_start(list, request);
  void* const argument = va_arg(list, void*);
  va_end(list);
  return next<int(int, unsigned long, ...)>(kept, "ioctl")(fd, request, argument);
}
// Calls without a function in the C library, mainly futex.
extern "C" long syscall(long number, ...) noexcept {
  static std::atomic<void*> kept{nullptr};
  count_call("syscall");
  va_list list;
  va_start(list, number);
  long a[6];
  for (long& x : a) x = va_arg(list, long);
  va_end(list);
  return next<long(long, ...)>(kept, "syscall")(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}
#endif
// NOLINTEND
