// A lightnetd that knows the learner, too, so that a test can kill it while it prepares.
//   learning_daemon CACHE PLACES
#include <atomic>
#include <cstdlib>
#include <iostream>

#include "tests/support/learner.hpp"
#include "transport/daemon/host.hpp"

int main(int, char** words) {
    const auto registry = lightnet::test::with_learner();
    lightnet::Host::Options options;
    options.cache = words[1];
    options.places = static_cast<std::uint32_t>(std::atoi(words[2]));
    lightnet::Host host(options, registry);
    std::cout << "listening on " << host.endpoint() << std::endl;
    const std::atomic<bool> never{false};
    host.serve(never);
}
