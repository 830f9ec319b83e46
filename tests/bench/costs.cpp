#include "tests/bench/costs.hpp"

#include <poll.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>

#include "tests/bench/figure.hpp"

namespace {

std::atomic<long> calls{0};

template <class... Arguments>
long counted(long number, Arguments... arguments) {
    calls.fetch_add(1, std::memory_order_relaxed);
    return syscall(number, arguments...);
}

}  // namespace

// Stand in for those of the C library, for all of this process.
extern "C" {
ssize_t read(int from, void* to, size_t size) { return counted(SYS_read, from, to, size); }
ssize_t write(int to, const void* from, size_t size) { return counted(SYS_write, to, from, size); }
ssize_t recvfrom(int from, void* to, size_t size, int flags, sockaddr* who, socklen_t* length) {
    return counted(SYS_recvfrom, from, to, size, flags, who, length);
}
ssize_t sendto(int to, const void* from, size_t size, int flags, const sockaddr* who, socklen_t length) {
    return counted(SYS_sendto, to, from, size, flags, who, length);
}
ssize_t recv(int from, void* to, size_t size, int flags) { return recvfrom(from, to, size, flags, nullptr, nullptr); }
ssize_t send(int to, const void* from, size_t size, int flags) { return sendto(to, from, size, flags, nullptr, 0); }
int poll(pollfd* items, nfds_t count, int most_ms) {
    return static_cast<int>(counted(SYS_poll, items, count, most_ms));
}
int epoll_wait(int at, epoll_event* events, int count, int most_ms) {
    return static_cast<int>(counted(SYS_epoll_wait, at, events, count, most_ms));
}
}

namespace lightnet::bench {

Costs costs_so_far() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return {double(calls.load()), double(used.ru_nvcsw + used.ru_nivcsw), process_seconds()};
}

Costs costs_since(const Costs& before, double count) {
    const auto now = costs_so_far();
    return {(now.calls - before.calls) / count, (now.switches - before.switches) / count,
            (now.seconds - before.seconds) / count};
}

}  // namespace lightnet::bench
