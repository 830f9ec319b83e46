// A lightnetd that knows emulated nodes instead of real ones: emulated_daemon ENDPOINT PLACES
#include <atomic>
#include <csignal>
#include <cstdlib>

#include "tests/bench/emulated.hpp"
#include "tests/support/folder.hpp"
#include "transport/daemon/host.hpp"

namespace {
std::atomic<bool> stop{false};
}

int main(int, char** words) {
    std::signal(SIGTERM, [](int) { stop = true; });
    const auto registry = lightnet::bench::emulated_kinds(nullptr, "");
    const lightnet::test::Folder cache;
    lightnet::Host::Options options;
    options.listen = words[1];
    options.cache = cache.path() / "cache";
    options.places = static_cast<std::uint32_t>(std::atoi(words[2]));
    lightnet::Host host(options, registry);
    host.serve(stop);
}
