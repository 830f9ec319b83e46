#include "tools/daemon_options.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <string>
#include <utility>

#include "core/base/build_info.hpp"
#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

/// The grammar of the command line, and what it fills.
class DaemonGrammar {
public:
    DaemonGrammar()
        : app_("Renders for others. Serves one run at a time, run after run, until it is told to stop.", "lightnetd") {
        add_reach();
        add_stay();
        takes_numbers(app_.add_option("--places", host().places, "threads that render; 0: one per core"), "N", 0, 1024)
            ->capture_default_str();
        app_.add_option("--cache", host().cache, "folder for files of scenes (default: ~/.cache/lightnet)")
            ->type_name("FOLDER");
        app_.add_option("--cache-size", host().cache_size, "bytes that the cache may keep, like 500M")
            ->type_name("SIZE")
            ->default_str("4G")
            ->transform(CLI::AsSizeValue(false).description(""));
        app_.add_flag("--quiet", options_.quiet, "say nothing but where it listens");
        app_.add_option("--parent", options_.parent, "end when this process ends")->group("");
        app_.set_version_flag("--version", "lightnetd " + build_id());
        add_examples(app_, {"lightnetd --listen tcp://127.0.0.1:7777 --places 4",
                            "lightnetd --join tcp://127.0.0.1:7000 --name onyx1"});
    }

    std::variant<DaemonOptions, Finished> parse(const std::vector<std::string>& arguments) {
        if (auto finished = take_apart(app_, arguments)) return *finished;
        if (!host().join.empty() && app_.count("--listen") == 0) host().listen.clear();
        host().drain = std::chrono::seconds(drain_);
        if (patience_) host().patience = std::chrono::seconds(patience_);
        for (const auto& [option, endpoint] :
             {std::pair{"--listen ", host().listen}, std::pair{"--join ", host().join}})
            if (!insecure_ && !endpoint.empty() && !stays_on_this_machine(endpoint))
                return usage_error(app_, beyond_this_machine(option + endpoint));
        return options_;
    }

private:
    Host::Options& host() { return options_.host; }

    void add_reach() {
        takes_endpoint(
            app_.add_option("--listen", host().listen, "where launchers find it; port * lets the system choose"), true)
            ->capture_default_str();
        takes_endpoint(
            app_.add_option("--join", host().join,
                            "dial out to this launcher, now or when it comes; lets nobody in unless --listen is "
                            "given, too"),
            false);
        app_.add_option("--name", host().name, "under which it joins (default: the name of the machine)");
        app_.add_option("--pass", host().pass,
                        "file with what it must know to join (default: ~/.config/lightnet/pass, made when missing)")
            ->type_name("FILE");
        app_.add_flag("--insecure", insecure_,
                      "reach beyond this machine, unencrypted: whoever reaches the port can have it render");
    }

    void add_stay() {
        takes_numbers(
            app_.add_option("--drain", drain_, "time to finish what it has when it is told to stop (SIGTERM)"),
            "SECONDS", 0, 86400)
            ->capture_default_str();
        takes_numbers(app_.add_option("--leave-after", patience_, "stop after so long without a run"), "SECONDS", 1,
                      864000);
        app_.add_option("--single", options_.single, "wait until no other daemon of this user here has this name")
            ->type_name("NAME");
    }

    CLI::App app_;
    DaemonOptions options_;
    int drain_ = 20, patience_ = 0;
    bool insecure_ = false;
};

}  // namespace

std::variant<DaemonOptions, Finished> parse_daemon_options(const std::vector<std::string>& arguments) {
    return DaemonGrammar().parse(arguments);
}

}  // namespace lightnet
