// The worker daemon: lends the cores of its host to one run after the other.
#include <CLI/CLI.hpp>

#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include "core/build_info.hpp"
#include "core/error.hpp"
#include "nodes/standard_nodes.hpp"
#include "tools/exit_code.hpp"
#include "tools/signals.hpp"
#include "tools/single_instance.hpp"
#include "transport/descriptors.hpp"
#include "transport/host.hpp"
#include "transport/reach.hpp"

namespace {

// Ends with the launcher that started it, however that ends.
void live_no_longer_than(int parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("lightnetd: renders for others. Serves one run at a time, run after run, until it is told to stop.");
    lightnet::Host::Options options;
    bool insecure = false, quiet = false;
    int parent = 0, drain = 20, patience = 0;
    std::string single;
    auto* const listen =
        app.add_option("--listen", options.listen, "where launchers find it; port * lets the system choose")
            ->capture_default_str();
    app.add_option("--join", options.join,
                   "dial out to this launcher, now or when it comes; lets nobody in unless --listen is given, too")
        ->type_name("tcp://HOST:PORT");
    app.add_option("--name", options.name, "under which it joins (default: the name of the machine)");
    app.add_option("--drain", drain, "seconds to finish what it has when it is told to stop (SIGTERM)")
        ->capture_default_str()
        ->check(CLI::Range(0, 86400));
    app.add_option("--leave-after", patience, "stop after so many seconds without a run")->check(CLI::Range(1, 864000));
    app.add_option("--single", single, "wait until no other daemon of this user on this machine has this name");
    app.add_option("--places", options.places, "threads that render; 0: one per core")->capture_default_str();
    app.add_option("--cache", options.cache, "folder for files of scenes (default: ~/.cache/lightnet)");
    app.add_option("--pass", options.pass,
                   "file with what it must know to join (default: ~/.config/lightnet/pass, made when missing)");
    app.add_flag("--insecure", insecure,
                 "reach beyond this machine, unencrypted: whoever reaches the port can have it render");
    app.add_option("--cache-size", options.cache_size, "bytes that the cache may keep, like 500M")
        ->type_name("SIZE")
        ->default_str("4G")
        ->transform(CLI::AsSizeValue(false).description(""));
    app.add_flag("--quiet", quiet, "say nothing but where it listens");
    app.add_option("--parent", parent, "end when this process ends")->group("");
    app.set_version_flag("--version", "lightnetd " + lightnet::build_id());
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? lightnet::exit_code::done : lightnet::exit_code::usage;
    }
    if (!options.join.empty() && listen->count() == 0) options.listen.clear();
    options.drain = std::chrono::seconds(drain);
    if (patience) options.patience = std::chrono::seconds(patience);
    for (const auto& [option, endpoint] :
         {std::pair{"--listen ", options.listen}, std::pair{"--join ", options.join}}) {
        if (insecure || endpoint.empty() || lightnet::stays_on_this_machine(endpoint)) continue;
        std::cerr << "lightnetd: " << lightnet::beyond_this_machine(option + endpoint) << '\n';
        return lightnet::exit_code::usage;
    }
    if (parent) live_no_longer_than(parent);
    if (!quiet && !parent)
        options.log = [](const std::string& text) { std::cerr << "lightnetd: " << text << std::endl; };
    try {
        const auto& stop = lightnet::watch_signals();
        lightnet::raise_descriptor_limit();
        std::optional<lightnet::SingleInstance> only;
        if (!single.empty()) only.emplace(single, stop.any);
        const lightnet::Registry registry{lightnet::standard_nodes()};
        lightnet::Host host(options, registry);
        if (options.listen.empty())
            std::cout << "joining " << options.join << std::endl;
        else
            std::cout << "listening on " << host.endpoint() << std::endl;
        host.serve(stop.any);
        if (host.hangs()) {
            std::cerr << "lightnetd: leaves behind work that does not end" << std::endl;
            std::_Exit(0);
        }
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "lightnetd: " << error.what() << '\n';
        return 1;
    }
}
