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
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/base/this_machine.hpp"
#include "core/base/words_of.hpp"
#include "lua/custom.hpp"
#include "nodes/examples/candela/candela_kinds.hpp"
#include "nodes/standard_nodes.hpp"
#include "tools/cli/settings.hpp"
#include "tools/daemon/daemon_log.hpp"
#include "tools/daemon/daemon_options.hpp"
#include "tools/daemon/led_by_input.hpp"
#include "tools/daemon/metrics.hpp"
#include "tools/daemon/metrics_server.hpp"
#include "tools/daemon/supervisor.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/plugins.hpp"
#include "tools/support/signals.hpp"
#include "tools/support/single_instance.hpp"
#include "tools/support/spare_cache.hpp"
#include "tools/support/standard_output.hpp"
#include "transport/daemon/host.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/places/descriptors.hpp"

namespace {

// Ends with the launcher that started it, however that ends.
void live_no_longer_than(int parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
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
void say_where_nobody_reads(lightnet::StandardOutput& output, const lightnet::DaemonLog& log) {
    const auto trouble = output.trouble();
    if (trouble.empty()) return;
    log({lightnet::LogLevel::warning, "where it listens can't be written to standard output: " + trouble});
    output.forgive();
}

// What this machine's plugins are worth is told as all else.
void load_all_plugins(const lightnet::DaemonOptions& options, lightnet::Registry& registry,
                      const lightnet::DaemonLog& log) {
    std::ostringstream complaints;
    lightnet::load_installed_plugins(registry, complaints);
    std::istringstream lines(complaints.str());
    for (std::string line; std::getline(lines, line);) log({lightnet::LogLevel::warning, line});
    lightnet::load_plugins(options.plugins, registry);
}

// Without these options and what belongs to them.
std::vector<std::string> without(const std::vector<std::string>& names, const std::vector<std::string>& words) {
    std::vector<std::string> left;
    for (auto word = words.begin(); word != words.end(); ++word) {
        const auto name = word->substr(0, word->find('='));
        if (std::find(names.begin(), names.end(), name) == names.end())
            left.push_back(*word);
        else if (name == *word && word + 1 != words.end())
            ++word;
    }
    return left;
}

// `words`: as typed, and what settings say besides.
int serve_several(const lightnet::DaemonOptions& options, const std::vector<std::string>& words,
                  const lightnet::DaemonLog& log, lightnet::StandardOutput& output) {
    const auto& stop = lightnet::watch_signals();
    std::optional<lightnet::SingleInstance> only;
    if (!options.single.empty()) only.emplace(options.single, stop.any);
    lightnet::supervise(
        {options.runs, options.host.listen, options.metrics,
         without({"--listen", "--runs", "--metrics", "--single", "--memory"}, words), options.quiet, options.memory},
        stop, log);
    say_where_nobody_reads(output, log);
    return lightnet::exit_code::done;
}

int serve(lightnet::DaemonOptions options, const lightnet::DaemonLog& log, lightnet::StandardOutput& output) {
    // OpenSSL looks for its hashes once, and has none for ever after where there was no memory for that.
    const lightnet::Hasher first_of_all;
    options.host.key = options.led ? lightnet::key_from_input() : lightnet::take_key_from_environment();
    if (options.led && !options.host.key) return lightnet::exit_code::done;  // whoever holds it has let go
    if (!options.host.key && (!options.host.allow.empty() || options.host.launcher_key))
        options.host.key = own_key(options);
    if (options.parent) live_no_longer_than(options.parent);
    if (options.supervisor) {
        live_no_longer_than(options.supervisor);
        // Terminals and service managers tell each process; the one that all of them look like hands it on as SIGUSR1.
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
    }
    if (options.parent || options.led) options.metrics.clear();  // of the one daemon that the environment may be for
    if (!options.quiet && !options.parent) options.host.log = log;
    const auto& stop = lightnet::watch_signals();
    options.host.why_told = [&stop] {
        return stop.said == lightnet::memory_is_needed ? std::string("other runs of its daemon need its memory") : "";
    };
    std::optional<lightnet::LedByInput> led;
    if (options.led) led.emplace();
    lightnet::raise_descriptor_limit();
    std::optional<lightnet::SingleInstance> only;
    if (!options.single.empty()) only.emplace(options.single, stop.any);
    lightnet::Registry registry{lightnet::standard_nodes()};
    registry.add(lightnet::candela_kinds());  // an example: code that was written for something else
    registry.add({lightnet::custom_kind()});
    load_all_plugins(options, registry, log);
    std::optional<lightnet::SpareCache> spare;
    if (options.host.cache.empty())
        options.host.cache = lightnet::cache_or_spare(spare, "this daemon keeps", [&](const std::string& text) {
            log({lightnet::LogLevel::warning, text});
        });
    lightnet::Host host(options.host, registry);
    if (options.host.listen.empty())
        log.announce("joining " + options.host.join);
    else
        log.announce("listening on " + host.endpoint());
    std::optional<lightnet::MetricsServer> metrics;
    if (!options.metrics.empty()) {
        metrics.emplace(
            options.metrics, [&host] { return lightnet::metrics_of(host.figures()); },
            [&host] { return lightnet::why_unfit(host.figures(), std::chrono::steady_clock::now()); });
        log.announce("metrics at " + metrics->url());
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

// The words may be wrong, and that, too, is to be told in this format.
bool wants_json(const std::vector<std::string>& words) {
    const std::string option = "--log-format";
    for (auto word = words.begin(); word != words.end(); ++word)
        if (*word == option + "=json" || (*word == option && word + 1 != words.end() && *(word + 1) == "json"))
            return true;
    return false;
}

int perform(std::vector<std::string> typed, lightnet::DaemonLog& log, lightnet::StandardOutput& output) {
    auto settings = lightnet::settings_of_daemon();
    const auto text = lightnet::daemon_texts().front();
    if (std::find(typed.begin(), typed.end(), "--print-config") != typed.end()) {
        std::cout << lightnet::settings_table(settings.settled(text, typed));
        return lightnet::exit_code::done;
    }
    // One that a launcher starts does what that says.
    const bool has_parent = std::find(typed.begin(), typed.end(), "--parent") != typed.end();
    if (has_parent || std::find(typed.begin(), typed.end(), "--supervisor") != typed.end()) settings.lines.clear();
    const auto more = settings.missing(text, typed);
    typed.insert(typed.begin(), more.begin(), more.end());
    if (has_parent) typed.insert(typed.end(), {"--log-format", "text"});  // which it waits for
    log = lightnet::DaemonLog(wants_json(typed) && !has_parent, lightnet::machine_name());
    const auto parsed = lightnet::parse_daemon_options(typed);
    if (const auto* finished = std::get_if<lightnet::Finished>(&parsed)) {
        std::cout << finished->out;
        if (const auto end = finished->err.find_last_not_of('\n'); end != std::string::npos)
            log.give_up(finished->err.substr(0, end + 1));
        return finished->code;
    }
    const auto& options = std::get<lightnet::DaemonOptions>(parsed);
    if (!options.host.name.empty()) log = lightnet::DaemonLog(options.log_json, options.host.name);
    if (options.print_key) return print_key(options);
    return options.runs > 1 ? serve_several(options, typed, log, output) : serve(options, log, output);
}

int perform_in_words(const std::vector<std::string>& typed, lightnet::StandardOutput& output) {
    lightnet::DaemonLog log(wants_json(typed), lightnet::machine_name());
    try {
        return perform(typed, log, output);
    } catch (const lightnet::UserError& error) {
        log.give_up(error.what());
        return lightnet::exit_code::usage;
    } catch (const std::bad_alloc&) {
        log.give_up("lightnetd: there is not enough memory to serve");
        return lightnet::exit_code::failed;
    } catch (const std::exception& error) {
        log.give_up("lightnetd: " + lightnet::words_of(error));
        return lightnet::exit_code::failed;
    }
}

}  // namespace

int main(int count, char** words) {
    lightnet::end_on_signals(lightnet::exit_code::done, "lightnetd: stopped by a signal\n");
    lightnet::keep_standard_descriptors();
    lightnet::StandardOutput output;
    return output.end(perform_in_words({words + 1, words + count}, output), "lightnetd");
}
