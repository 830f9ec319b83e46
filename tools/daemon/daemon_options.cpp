#include "tools/daemon/daemon_options.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <string>
#include <utility>

#include "core/base/build_info.hpp"
#include "core/network/graph/hosts.hpp"
#include "tools/http/watch_rules.hpp"
#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

/// The grammar of the command line, and what it fills.
class DaemonGrammar {
public:
    DaemonGrammar()
        : app_("Renders for others. Serves one run at a time (or --runs), run after run, until it is told to stop.",
               "lightnetd") {
        add_reach();
        add_keys();
        add_stay();
        add_everywhere(app_, options_.plugins);
        takes_numbers(
            app_.add_option("--runs", options_.runs,
                            "runs that it serves at a time, each at a port: that of --listen, and those after it"),
            "N", 1, 64)
            ->capture_default_str();
        takes_numbers(app_.add_option("--places", host().places, "threads that render; 0: one per core"), "N", 0, 1024)
            ->capture_default_str();
        app_.add_option("--cache", host().cache, "folder for files of scenes (default: ~/.cache/lightnet)")
            ->type_name("FOLDER");
        app_.add_option("--cache-size", host().cache_size, "bytes that the cache may keep, like 500M")
            ->type_name("SIZE")
            ->default_str("4G")
            ->transform(CLI::AsSizeValue(false).description(""));
        app_.add_option("--memory", options_.memory,
                        "bytes that the processes of --runs may hold together, like 24G; when they have more, the one "
                        "that has been idle for longest ends, and is started anew")
            ->type_name("SIZE")
            ->transform(CLI::AsSizeValue(false).description(""));
        app_.add_option("--metrics", options_.metrics, "tell Prometheus how it does: GET http://ADDRESS:PORT/metrics")
            ->type_name("ADDRESS:PORT");
        app_.add_option_function<std::string>(
                "--log-format", [this](const std::string& text) { options_.log_json = text == "json"; },
                "how its log is written: text, or a line of JSON for each entry, with time, level, host and run")
            ->type_name("text|json")
            ->default_str("text")
            ->check([](const std::string& text) {
                return text == "text" || text == "json" ? "" : "must be text or json, not '" + text + "'";
            });
        app_.add_flag("--quiet", options_.quiet, "say nothing but where it listens");
        app_.add_option("--parent", options_.parent, "end when this process ends")->group("");
        app_.add_option("--supervisor", options_.supervisor, "one of several daemons of this process")->group("");
        app_.add_option("--ports", host().ports, "of these, its own first")->group("");
        app_.add_flag("--led", options_.led, "read the key from the standard input, and end with that")->group("");
        app_.set_version_flag("--version", "lightnetd " + build_id());
        add_examples(app_, {"lightnetd --listen tcp://127.0.0.1:7777 --places 4",
                            "lightnetd --join tcp://127.0.0.1:7000 --name onyx1",
                            "lightnetd --listen tcp://0.0.0.0:7777 --allow launchers.keys", "lightnetd --print-key"});
    }

    std::variant<DaemonOptions, Finished> parse(const std::vector<std::string>& arguments) {
        if (auto finished = take_apart(app_, arguments)) return *finished;
        if (!host().join.empty() && app_.count("--listen") == 0) host().listen.clear();
        host().drain = std::chrono::seconds(options_.led ? 0 : drain_);  // whoever led it is gone
        if (patience_) host().patience = std::chrono::seconds(patience_);
        for (const auto& [option, endpoint] :
             {std::pair{std::string("--listen "), host().listen}, std::pair{std::string("--join "), host().join}})
            if (!insecure_ && !endpoint.empty() && !stays_on_this_machine(endpoint) && !has_keys(option))
                return usage_error(app_, beyond_this_machine(option + endpoint, way_with_keys(option)));
        const auto& metrics = options_.metrics;
        const auto told_at = watch_address(metrics);
        if (!told_at)
            return usage_error(app_,
                               "--metrics takes an address like 127.0.0.1:9100 or [::1]:9100, not '" + metrics + "'");
        if (!insecure_ && !told_at->stays_here())
            return usage_error(
                app_, beyond_this_machine("--metrics " + metrics, "put a server with TLS in front of 127.0.0.1"));
        if (options_.parent || options_.led) options_.runs = 1;
        const std::string several = "--runs " + std::to_string(options_.runs) + ": ";
        if (options_.runs > 1 && !host().join.empty())
            return usage_error(app_, several + "a daemon that joins a launcher serves that alone; leave --join out");
        if (options_.runs > 1 && patience_)
            return usage_error(app_, several + "--leave-after is of a daemon that serves one run at a time");
        if (options_.runs == 1 && options_.memory && !options_.supervisor && !options_.parent && !options_.led)
            return usage_error(app_, "--memory is of a daemon that serves several runs: say --runs, too");
        if (options_.runs > 1 && !metrics.empty() && told_at->port == 0)
            return usage_error(
                app_, several + "--metrics needs a port, for the first of them; others tell at those after it");
        return options_;
    }

    std::vector<VerbText> texts() const { return texts_of(app_); }

private:
    Host::Options& host() { return options_.host; }

    // A launcher that it joins tells it whose questions to take; one that calls it must be on its list.
    bool has_keys(const std::string& option) const {
        return options_.host.launcher_key || (option == "--listen " && !options_.host.allow.empty());
    }
    static std::string way_with_keys(const std::string& option) {
        return option == "--listen " ? "say --allow FILE with the keys of those who may use it"
                                     : "say --launcher-key KEY, which lightnet key shows";
    }

    void add_keys() {
        app_.add_option("--key", options_.key_file,
                        "file with its own secret key (default: ~/.config/lightnet/key, made when missing)")
            ->type_name("FILE");
        app_.add_option("--allow", host().allow,
                        "let in only whose keys are in this file (one a line, and a name behind it; read again when it "
                        "changes), or one public key")
            ->type_name("FILE|KEY");
        app_.add_option_function<std::string>(
                "--launcher-key", [this](const std::string& text) { host().launcher_key = PublicKey::from(text); },
                "the public key of the launcher that it joins")
            ->type_name("KEY")
            ->check([](const std::string& text) { return mistake_in_key(text); });
        app_.add_flag("--print-key", options_.print_key, "print its public key, for hosts files, and end");
    }

    void add_reach() {
        takes_endpoint(
            app_.add_option("--listen", host().listen, "where launchers find it; port * lets the system choose"), true)
            ->capture_default_str();
        takes_endpoint(
            app_.add_option("--join", host().join,
                            "dial out to this launcher, now or when it comes; lets nobody in unless --listen is "
                            "given, too"),
            false);
        app_.add_option("--name", host().name, "under which it joins (default: the name of the machine)")
            ->check([](const std::string& name) {
                return name == own_process ? "'here' is what hosts files call the launcher's own process" : "";
            });
        app_.add_option("--pass", host().pass,
                        "file with what it must know to join (default: ~/.config/lightnet/pass, made when missing)")
            ->type_name("FILE");
        app_.add_flag(
            "--insecure", insecure_,
            "reach beyond this machine without keys, unencrypted: whoever reaches the port can have it render");
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

std::vector<VerbText> daemon_texts() { return DaemonGrammar().texts(); }

}  // namespace lightnet
