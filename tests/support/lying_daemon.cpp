// A lightnetd with an operator that answers falsely now and then.
//   lying_daemon CACHE KIND PART [KEY ALLOW]
#include <atomic>
#include <cstdlib>
#include <iostream>

#include "tests/support/lying_kinds.hpp"
#include "transport/daemon/host.hpp"
#include "transport/keys/key_file.hpp"

int main(int count, char** words) {
    const auto registry = lightnet::test::with_liar(words[2], std::atof(words[3]));
    lightnet::Host::Options options;
    options.cache = words[1];
    options.places = 1;
    if (count > 5) {
        options.key = lightnet::load_or_make_key(words[4]);
        options.allow = words[5];
    }
    lightnet::Host host(options, registry);
    std::cout << "listening on " << host.endpoint() << std::endl;
    const std::atomic<bool> never{false};
    host.serve(never);
}
