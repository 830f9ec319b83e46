// The worker daemon: lends the cores of its host to one run after the other.
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/this_machine.hpp"
#include "lua/custom.hpp"
#include "nodes/examples/candela/candela_kinds.hpp"
#include "nodes/standard_nodes.hpp"
#include "tools/daemon_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/log_line.hpp"
#include "tools/metrics.hpp"
#include "tools/metrics_server.hpp"
#include "tools/plugins.hpp"
#include "tools/settings.hpp"
#include "tools/signals.hpp"
#include "tools/single_instance.hpp"
#include "tools/standard_output.hpp"
#include "transport/daemon/host.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/places/descriptors.hpp"

namespace {

// Ends with the launcher that started it, however that ends.
void live_no_longer_than(int parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
}

// A line at once, also when another process writes to the same file.
std::function<void(const lightnet::LogEntry&)> writer_of_log(const lightnet::DaemonOptions& options) {
    const bool json = options.log_json;
    const auto host = options.host.name.empty() ? lightnet::machine_name() : options.host.name;
    return [json, host](const lightnet::LogEntry& entry) {
        const auto now = std::chrono::system_clock::now();
        std::cerr << (json ? lightnet::log_json("lightnetd", host, entry, now)
                           : lightnet::log_line("lightnetd", entry.text, now)) +
                         "\n"
                  << std::flush;
    };
}

lightnet::KeyPair own_key(const lightnet::DaemonOptions& options) {
    return lightnet::load_or_make_key(options.key_file.empty() ? lightnet::usual_key_file() : options.key_file);
}

int print_key(const lightnet::DaemonOptions& options) {
    const auto key = own_key(options).open;
    std::cout << key.text() << std::endl;
    std::cerr << "fingerprint " << key.fingerprint() << '\n';
    return lightnet::exit_code::done;
}

// Who starts it may wait for these lines in vain; it serves all the same.
void say_where_nobody_reads(lightnet::StandardOutput& output,
                            const std::function<void(const lightnet::LogEntry&)>& log) {
    const auto trouble = output.trouble();
    if (trouble.empty()) return;
    log({lightnet::LogLevel::warning, "where it listens can't be written to standard output: " + trouble});
    output.forgive();
}

int serve(lightnet::DaemonOptions options, lightnet::StandardOutput& output) {
    if (options.print_key) return print_key(options);
    options.host.key = lightnet::take_key_from_environment();
    if (!options.host.key && (!options.host.allow.empty() || options.host.launcher_key))
        options.host.key = own_key(options);
    if (options.parent) live_no_longer_than(options.parent);
    const auto log = writer_of_log(options);
    if (!options.quiet && !options.parent) options.host.log = log;
    const auto& stop = lightnet::watch_signals();
    lightnet::raise_descriptor_limit();
    std::optional<lightnet::SingleInstance> only;
    if (!options.single.empty()) only.emplace(options.single, stop.any);
    lightnet::Registry registry{lightnet::standard_nodes()};
    registry.add(lightnet::candela_kinds());  // an example: code that was written for something else
    registry.add({lightnet::custom_kind()});
    lightnet::load_installed_plugins(registry, std::cerr);
    lightnet::load_plugins(options.plugins, registry);
    lightnet::Host host(options.host, registry);
    if (options.host.listen.empty())
        std::cout << "joining " << options.host.join << std::endl;
    else
        std::cout << "listening on " << host.endpoint() << std::endl;
    std::optional<lightnet::MetricsServer> metrics;
    if (!options.metrics.empty()) {
        metrics.emplace(options.metrics, [&host] { return lightnet::metrics_of(host.figures()); });
        std::cout << "metrics at " << metrics->url() << std::endl;
    }
    say_where_nobody_reads(output, log);
    host.serve(stop.any);
    metrics.reset();
    if (host.hangs()) {
        log({lightnet::LogLevel::warning, "leaves behind work that does not end"});
        std::_Exit(lightnet::exit_code::done);
    }
    return lightnet::exit_code::done;
}

int perform(std::vector<std::string> typed, lightnet::StandardOutput& output) try {
    auto settings = lightnet::settings_of_daemon();
    const auto text = lightnet::daemon_texts().front();
    if (std::find(typed.begin(), typed.end(), "--print-config") != typed.end()) {
        std::cout << lightnet::settings_table(settings.settled(text, typed));
        return lightnet::exit_code::done;
    }
    // One that a launcher starts does what that says.
    if (std::find(typed.begin(), typed.end(), "--parent") != typed.end()) settings.lines.clear();
    const auto more = settings.missing(text, typed);
    typed.insert(typed.begin(), more.begin(), more.end());
    const auto parsed = lightnet::parse_daemon_options(typed);
    if (const auto* finished = std::get_if<lightnet::Finished>(&parsed)) {
        std::cout << finished->out;
        std::cerr << finished->err;
        return finished->code;
    }
    return serve(std::get<lightnet::DaemonOptions>(parsed), output);
} catch (const lightnet::UserError& error) {
    std::cerr << error.what() << '\n';
    return lightnet::exit_code::usage;
} catch (const std::exception& error) {
    std::cerr << "lightnetd: " << error.what() << '\n';
    return lightnet::exit_code::failed;
}

}  // namespace

int main(int count, char** words) {
    lightnet::keep_standard_descriptors();
    lightnet::StandardOutput output;
    return output.end(perform({words + 1, words + count}, output), "lightnetd");
}
