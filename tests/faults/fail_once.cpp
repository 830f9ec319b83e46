// Loaded before a program, this makes one call of the system's fail: the LIGHTNET_FAIL_AT-th of the kind LIGHTNET_FAIL
// in all processes of the program LIGHTNET_FAIL_IN ("" or none: of any) together. Kinds: memory (of LIGHTNET_FAIL_LEAST
// bytes at least), map, write (but not to the standard error, where complaints go), sync, rename, open, thread,
// process, descriptor, read. Whoever failed adds a line to the file LIGHTNET_FAIL_NOTE, which is there and has room: by
// which functions it was called; "spared" before it, and nothing failed, where one of them is in a library of
// LIGHTNET_FAIL_SPARES.
#include <dirent.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#include <stdarg.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

/// What is told is written into memory that all processes share: some of them may write no files.
struct Note {
    static constexpr std::size_t room = 1 << 16;
    std::atomic<std::size_t> calls, used;
    std::array<char, room - 2 * sizeof(std::size_t)> text;
    void add(const char* line, std::size_t size) {
        const std::size_t at = used.fetch_add(size);
        if (at + size <= text.size()) std::memcpy(text.data() + at, line, size);
    }
};
static_assert(sizeof(Note) == Note::room);

struct Order {
    const char *kind = "", *spares = "";
    Note* note = nullptr;
    std::size_t at = 0, least = 0;
    bool here = false;
};

thread_local bool inside = false;  // what is called from here itself does not count

const char* word(const char* name) {
    const char* const value = std::getenv(name);
    return value ? value : "";
}

Note* note_in(const char* path) {
    const long file = syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC);
    if (file < 0) return nullptr;
    const long at = syscall(SYS_mmap, nullptr, Note::room, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    syscall(SYS_close, file);
    return at == -1 ? nullptr : reinterpret_cast<Note*>(at);
}

const Order& order() {
    static const Order given = [] {
        Order order;
        order.kind = word("LIGHTNET_FAIL");
        order.note = note_in(word("LIGHTNET_FAIL_NOTE"));
        order.spares = word("LIGHTNET_FAIL_SPARES");
        order.at = static_cast<std::size_t>(std::atol(word("LIGHTNET_FAIL_AT")));
        order.least = static_cast<std::size_t>(std::atol(word("LIGHTNET_FAIL_LEAST")));
        const char* const in = word("LIGHTNET_FAIL_IN");
        order.here = order.note && order.at > 0 && (!*in || std::strcmp(in, program_invocation_short_name) == 0);
        return order;
    }();
    return given;
}

const char* base_name(const char* path) {
    const char* const slash = std::strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// Is one of the libraries named in `names`, which are divided by colons?
bool is_spared(const char* library, const char* names) {
    for (const char* at = names; *at;) {
        const std::size_t size = std::strcspn(at, ":");
        if (size > 0 && std::strncmp(library, at, size) == 0) return true;
        at += size + (at[size] == ':');
    }
    return false;
}

// Writes who called, and says whether it may fail.
bool may_fail(const Order& order) {
    std::array<void*, 48> frames{};
    const int depth = backtrace(frames.data(), static_cast<int>(frames.size()));
    std::array<char, 6000> text{};
    std::size_t size = 0;
    bool spared = false;
    for (int i = 2; i < depth && size + 200 < text.size(); ++i) {
        Dl_info who{};
        if (!dladdr(frames[static_cast<std::size_t>(i)], &who) || !who.dli_fname) continue;
        const char* const library = base_name(who.dli_fname);
        spared |= is_spared(library, order.spares);
        const auto offset = static_cast<char*>(frames[static_cast<std::size_t>(i)]) - static_cast<char*>(who.dli_fbase);
        size += static_cast<std::size_t>(std::snprintf(text.data() + size, 180, " %.60s+0x%lx", library, offset));
    }
    std::array<char, 6200> line{};
    const int length = std::snprintf(line.data(), line.size(), "%s%s %s %zu%s\n", spared ? "spared " : "",
                                     program_invocation_short_name, order.kind, order.at, text.data());
    order.note->add(line.data(), static_cast<std::size_t>(length));
    return !spared;
}

bool fails(const char* kind, std::size_t size = ~std::size_t{0}) {
    if (inside || !environ) return false;
    inside = true;
    const Order& now = order();
    bool failed = false;
    if (now.here && std::strcmp(kind, now.kind) == 0 && size >= now.least && ++now.note->calls == now.at)
        failed = may_fail(now);
    inside = false;
    return failed;
}

template <class Function>
Function next(const char* name) {
    const bool before = inside;
    inside = true;
    const auto found = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
    inside = before;
    return found;
}

template <class Result>
Result with(int error, Result result) {
    errno = error;
    return result;
}

}  // namespace

// A call that goes on to the true one unless it has to fail.
#define INTERCEPT(result, name, parameters, arguments, kind, error, failure)    \
    extern "C" result name parameters {                                         \
        static const auto original = next<result(*) parameters>(#name);         \
        return fails(kind) ? with<result>(error, failure) : original arguments; \
    }

INTERCEPT(ssize_t, write, (int to, const void* data, size_t size), (to, data, size), to == 2 ? "" : "write", ENOSPC, -1)
INTERCEPT(ssize_t, writev, (int to, const iovec* parts, int count), (to, parts, count), to == 2 ? "" : "write", ENOSPC,
          -1)
INTERCEPT(ssize_t, pwrite, (int to, const void* data, size_t size, off_t at), (to, data, size, at), "write", ENOSPC, -1)
INTERCEPT(ssize_t, pwrite64, (int to, const void* data, size_t size, off64_t at), (to, data, size, at), "write", ENOSPC,
          -1)
INTERCEPT(size_t, fwrite, (const void* data, size_t size, size_t count, FILE* to), (data, size, count, to),
          to == stderr ? "" : "write", ENOSPC, 0)
INTERCEPT(int, fflush, (FILE * file), (file), file == stderr ? "" : "write", ENOSPC, EOF)
INTERCEPT(int, ftruncate, (int file, off_t size), (file, size), "write", ENOSPC, -1)
INTERCEPT(int, posix_fallocate, (int file, off_t at, off_t size), (file, at, size), "write", ENOSPC, ENOSPC)
INTERCEPT(ssize_t, read, (int from, void* data, size_t size), (from, data, size), "read", EIO, -1)
INTERCEPT(ssize_t, pread, (int from, void* data, size_t size, off_t at), (from, data, size, at), "read", EIO, -1)
INTERCEPT(int, fsync, (int file), (file), "sync", EIO, -1)
INTERCEPT(int, fdatasync, (int file), (file), "sync", EIO, -1)
INTERCEPT(int, rename, (const char* from, const char* to), (from, to), "rename", EIO, -1)
INTERCEPT(int, renameat, (int a, const char* from, int b, const char* to), (a, from, b, to), "rename", EIO, -1)
INTERCEPT(int, link, (const char* from, const char* to), (from, to), "rename", EIO, -1)
INTERCEPT(int, mkdir, (const char* path, mode_t mode), (path, mode), "open", ENOSPC, -1)
INTERCEPT(char*, mkdtemp, (char* path), (path), "open", ENOSPC, nullptr)
INTERCEPT(int, mkstemp, (char* path), (path), "open", EMFILE, -1)
INTERCEPT(FILE*, fopen, (const char* path, const char* mode), (path, mode), "open", EMFILE, nullptr)
INTERCEPT(FILE*, fopen64, (const char* path, const char* mode), (path, mode), "open", EMFILE, nullptr)
INTERCEPT(DIR*, opendir, (const char* path), (path), "open", EMFILE, nullptr)
INTERCEPT(int, socket, (int domain, int type, int protocol), (domain, type, protocol), "descriptor", EMFILE, -1)
INTERCEPT(int, accept, (int at, sockaddr* who, socklen_t* size), (at, who, size), "descriptor", EMFILE, -1)
INTERCEPT(int, accept4, (int at, sockaddr* who, socklen_t* size, int flags), (at, who, size, flags), "descriptor",
          EMFILE, -1)
INTERCEPT(int, epoll_create1, (int flags), (flags), "descriptor", EMFILE, -1)
INTERCEPT(int, eventfd, (unsigned start, int flags), (start, flags), "descriptor", EMFILE, -1)
INTERCEPT(int, timerfd_create, (int clock, int flags), (clock, flags), "descriptor", EMFILE, -1)
INTERCEPT(int, socketpair, (int domain, int type, int protocol, int* ends), (domain, type, protocol, ends),
          "descriptor", EMFILE, -1)
INTERCEPT(int, pipe, (int* ends), (ends), "descriptor", EMFILE, -1)
INTERCEPT(int, pipe2, (int* ends, int flags), (ends, flags), "descriptor", EMFILE, -1)
INTERCEPT(int, dup, (int file), (file), "descriptor", EMFILE, -1)
INTERCEPT(int, fork, (void), (), "process", EAGAIN, -1)
INTERCEPT(int, pthread_create, (pthread_t * thread, const pthread_attr_t* how, void* (*work)(void*), void* of),
          (thread, how, work, of), "thread", EAGAIN, EAGAIN)
INTERCEPT(int, posix_spawn,
          (pid_t * who, const char* path, const posix_spawn_file_actions_t* actions, const posix_spawnattr_t* how,
           char* const* words, char* const* variables),
          (who, path, actions, how, words, variables), "process", EAGAIN, EAGAIN)
INTERCEPT(int, posix_spawnp,
          (pid_t * who, const char* path, const posix_spawn_file_actions_t* actions, const posix_spawnattr_t* how,
           char* const* words, char* const* variables),
          (who, path, actions, how, words, variables), "process", EAGAIN, EAGAIN)
// The allocator asks for its own while it holds locks: that memory fails is another kind.
bool is_of_allocator(void* caller) {
    Dl_info who{};
    return dladdr(caller, &who) && who.dli_fname && std::strstr(who.dli_fname, "jemalloc");
}
#define INTERCEPT_MAP(name, offset)                                                                         \
    extern "C" void* name(void* at, size_t size, int rights, int flags, int file, offset from) {            \
        static const auto original = next<void* (*)(void*, size_t, int, int, int, offset)>(#name);          \
        if (!is_of_allocator(__builtin_return_address(0)) && fails("map")) return with(ENOMEM, MAP_FAILED); \
        return original(at, size, rights, flags, file, from);                                               \
    }
INTERCEPT_MAP(mmap, off_t)
INTERCEPT_MAP(mmap64, off64_t)

// With a mode that may follow.
#define INTERCEPT_OPEN(name)                                                      \
    extern "C" int name(const char* path, int flags, ...) {                       \
        static const auto original = next<int (*)(const char*, int, ...)>(#name); \
        va_list more;                                                             \
        va_start(more, flags);                                                    \
        const mode_t mode = va_arg(more, mode_t);                                 \
        va_end(more);                                                             \
        return fails("open") ? with(EMFILE, -1) : original(path, flags, mode);    \
    }
#define INTERCEPT_OPENAT(name)                                                         \
    extern "C" int name(int folder, const char* path, int flags, ...) {                \
        static const auto original = next<int (*)(int, const char*, int, ...)>(#name); \
        va_list more;                                                                  \
        va_start(more, flags);                                                         \
        const mode_t mode = va_arg(more, mode_t);                                      \
        va_end(more);                                                                  \
        return fails("open") ? with(EMFILE, -1) : original(folder, path, flags, mode); \
    }
INTERCEPT_OPEN(open)
INTERCEPT_OPEN(open64)
INTERCEPT_OPENAT(openat)
INTERCEPT_OPENAT(openat64)

// ---- memory ----

extern "C" void* malloc(size_t size) {
    static const auto original = next<void* (*)(size_t)>("malloc");
    return fails("memory", size) ? with<void*>(ENOMEM, nullptr) : original(size);
}
extern "C" void* calloc(size_t count, size_t size) {
    static const auto original = next<void* (*)(size_t, size_t)>("calloc");
    return fails("memory", count * size) ? with<void*>(ENOMEM, nullptr) : original(count, size);
}
extern "C" void* realloc(void* old, size_t size) {
    static const auto original = next<void* (*)(void*, size_t)>("realloc");
    return fails("memory", size) ? with<void*>(ENOMEM, nullptr) : original(old, size);
}
extern "C" int posix_memalign(void** to, size_t alignment, size_t size) {
    static const auto original = next<int (*)(void**, size_t, size_t)>("posix_memalign");
    return fails("memory", size) ? ENOMEM : original(to, alignment, size);
}
extern "C" void* aligned_alloc(size_t alignment, size_t size) {
    static const auto original = next<void* (*)(size_t, size_t)>("aligned_alloc");
    return fails("memory", size) ? with<void*>(ENOMEM, nullptr) : original(alignment, size);
}

void* operator new(std::size_t size) {
    static const auto original = next<void* (*)(std::size_t)>("_Znwm");
    if (fails("memory", size)) throw std::bad_alloc();
    return original(size);
}
void* operator new[](std::size_t size) {
    static const auto original = next<void* (*)(std::size_t)>("_Znam");
    if (fails("memory", size)) throw std::bad_alloc();
    return original(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    static const auto original = next<void* (*)(std::size_t, std::align_val_t)>("_ZnwmSt11align_val_t");
    if (fails("memory", size)) throw std::bad_alloc();
    return original(size, alignment);
}
void* operator new(std::size_t size, const std::nothrow_t& without) noexcept {
    static const auto original = next<void* (*)(std::size_t, const std::nothrow_t&)>("_ZnwmRKSt9nothrow_t");
    return fails("memory", size) ? nullptr : original(size, without);
}
