// The worker daemon: lends the cores of its host to one run after the other.
#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>

#include "nodes/standard_nodes.hpp"
#include "tools/daemon_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/log_line.hpp"
#include "tools/signals.hpp"
#include "tools/single_instance.hpp"
#include "transport/daemon/host.hpp"
#include "transport/places/descriptors.hpp"

namespace {

// Ends with the launcher that started it, however that ends.
void live_no_longer_than(int parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
}

void log(const std::string& text) {
    std::cerr << lightnet::log_line("lightnetd", text, std::chrono::system_clock::now()) << std::endl;
}

int serve(lightnet::DaemonOptions options) {
    if (options.parent) live_no_longer_than(options.parent);
    if (!options.quiet && !options.parent) options.host.log = log;
    const auto& stop = lightnet::watch_signals();
    lightnet::raise_descriptor_limit();
    std::optional<lightnet::SingleInstance> only;
    if (!options.single.empty()) only.emplace(options.single, stop.any);
    const lightnet::Registry registry{lightnet::standard_nodes()};
    lightnet::Host host(options.host, registry);
    if (options.host.listen.empty())
        std::cout << "joining " << options.host.join << std::endl;
    else
        std::cout << "listening on " << host.endpoint() << std::endl;
    host.serve(stop.any);
    if (host.hangs()) {
        log("leaves behind work that does not end");
        std::_Exit(lightnet::exit_code::done);
    }
    return lightnet::exit_code::done;
}

}  // namespace

int main(int count, char** words) try {
    const auto parsed = lightnet::parse_daemon_options({words + 1, words + count});
    if (const auto* finished = std::get_if<lightnet::Finished>(&parsed)) {
        std::cout << finished->out;
        std::cerr << finished->err;
        return finished->code;
    }
    return serve(std::get<lightnet::DaemonOptions>(parsed));
} catch (const std::exception& error) {
    std::cerr << "lightnetd: " << error.what() << '\n';
    return lightnet::exit_code::failed;
}
