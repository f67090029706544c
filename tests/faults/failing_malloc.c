/* failing_malloc.c -- the allocator of a process, preloaded: from when it is told to, the n-th allocation of at
   least so many bytes fails, once. For the GNU C library. */
#include <errno.h>
#include <stdatomic.h>
#include <stddef.h>

void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);

static atomic_long left = -1;   /* until the failure; below 0: none */
static atomic_long count;
static atomic_size_t least;

void fail_at(long n, size_t bytes) {
    atomic_store(&least, bytes);
    atomic_store(&count, 0);
    atomic_store(&left, n);
}

/* Allocations that counted since then. */
long counted(void) { return atomic_load(&count); }

static int fails(size_t bytes) {
    if (bytes < atomic_load(&least)) return 0;
    atomic_fetch_add(&count, 1);
    long now = atomic_load(&left);
    while (now >= 0 && !atomic_compare_exchange_weak(&left, &now, now - 1)) {}
    if (now == 0) errno = ENOMEM;
    return now == 0;
}

void* malloc(size_t n) { return fails(n) ? NULL : __libc_malloc(n); }
void* calloc(size_t n, size_t m) { return fails(n * m) ? NULL : __libc_calloc(n, m); }
void* realloc(void* p, size_t n) { return fails(n) ? NULL : __libc_realloc(p, n); }
void* memalign(size_t a, size_t n) { return fails(n) ? NULL : __libc_memalign(a, n); }
void* aligned_alloc(size_t a, size_t n) { return memalign(a, n); }
int posix_memalign(void** p, size_t a, size_t n) {
    void* const found = memalign(a, n);
    if (!found) return ENOMEM;
    *p = found;
    return 0;
}
