#include "tools/daemon/supervisor.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"
#include "tools/daemon/memory_bound.hpp"
#include "tools/http/watch_rules.hpp"
#include "transport/address/listening.hpp"
#include "transport/start/child.hpp"
#include "transport/start/daemon_start.hpp"
#include "transport/start/restarts.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto look_interval = std::chrono::milliseconds(50);
constexpr auto measure_interval = std::chrono::seconds(1);
constexpr auto of_use_after = std::chrono::seconds(10);
constexpr std::uint32_t most_ports = 65535;

std::string endpoint_at(const std::string& listen, std::uint32_t port) {
    auto parts = tcp_endpoint(listen).value();
    parts.port = std::to_string(port);
    return parts.text();
}

/// Processes of daemons, by number.
class Daemons {
public:
    Daemons(const SupervisedDaemons& wanted, const DaemonLog& log)
        : wanted_(wanted),
          log_(log),
          program_(std::filesystem::read_symlink("/proc/self/exe").string()),
          ports_(supervised_ports(wanted)),
          all_(wanted.runs),
          bound_(wanted.memory) {}
    ~Daemons() {
        for (const auto& one : all_)
            if (one.process) kill(one.process, SIGKILL);
        for (auto& one : all_)
            if (one.process) wait_for(one);
    }
    Daemons(const Daemons&) = delete;
    Daemons& operator=(const Daemons&) = delete;

    void start_all() {
        std::vector<int> outs;
        for (std::size_t i = 0; i < all_.size(); ++i) outs.push_back(start(i));
        for (std::size_t i = 0; i < all_.size(); ++i) {
            Patience patience(start_patience);
            const auto said = endpoint_said(outs[i], patience);
            all_[i].out = outs[i];
            if (!said) throw Error("the daemon for port " + std::to_string(ports_[i]) + " did not start");
            if (i == 0) first_ = *said;
        }
    }
    const std::string& first() const { return first_; }
    std::vector<std::string> metrics() const {
        std::vector<std::string> all;
        for (std::size_t i = 0; i < all_.size() && !wanted_.metrics.empty(); ++i) all.push_back(metrics_at(i));
        return all;
    }
    std::string ports_in_words() const {
        return std::to_string(ports_.front()) + " to " + std::to_string(ports_.back());
    }

    void look_after() {
        for (std::size_t i = 0; i < all_.size(); ++i) {
            auto& one = all_[i];
            int status = 0;
            const auto now = Clock::now();
            if (one.process && waitpid(one.process, &status, WNOHANG) == one.process) {
                forget(one);
                one.restarts.died(now, one.told || now - one.started > of_use_after);
                tell_death(i, status);
            } else if (!one.process && one.restarts.due(now)) {
                one.out = start(i);
            }
        }
        if (wanted_.memory && Clock::now() >= next_measure_) bound_memory(Clock::now());
        if (std::all_of(all_.begin(), all_.end(), [](const auto& one) { return one.restarts.given_up(); }))
            throw Error("none of its daemons stays");
    }

    void stop() {
        while (std::any_of(all_.begin(), all_.end(), [](const auto& one) { return one.process != 0; })) {
            for (auto& one : all_) tell_and_look(one);
            std::this_thread::sleep_for(look_interval);
        }
    }

private:
    struct Daemon {
        int process = 0;  // 0: it has ended
        int out = -1;     // its standard output, which nobody reads after its first line
        Clock::time_point started{};
        bool told = false;  // to end
        Restarts restarts{};
    };

    // Its own port comes first: whoever is turned away there tries the next.
    std::string ports_for(std::size_t number) const {
        auto ports = ports_;
        std::rotate(ports.begin(), ports.begin() + std::ptrdiff_t(number), ports.end());
        std::string words;
        for (const auto port : ports) words += (words.empty() ? "" : ",") + std::to_string(port);
        return words;
    }

    std::string metrics_at(std::size_t number) const {
        const auto at = watch_address(wanted_.metrics).value();
        return in_url(at.host) + ":" + std::to_string(at.port + number);
    }

    int start(std::size_t number) {
        std::vector<std::string> words{program_};
        words.insert(words.end(), wanted_.words.begin(), wanted_.words.end());
        words.insert(words.end(), {"--listen", endpoint_at(wanted_.listen, ports_[number]), "--ports",
                                   ports_for(number), "--supervisor", std::to_string(getpid())});
        if (!wanted_.metrics.empty()) words.insert(words.end(), {"--metrics", metrics_at(number)});
        int out = -1;
        auto& one = all_[number];
        one.process = spawn(std::move(words), &out);
        one.started = Clock::now();
        one.told = false;
        return out;
    }

    void tell_death(std::size_t number, int status) const {
        if (wanted_.quiet) return;
        const std::string how = WIFSIGNALED(status) ? "was ended by signal " + std::to_string(WTERMSIG(status))
                                                    : "has ended with code " + std::to_string(WEXITSTATUS(status));
        log_(
            {LogLevel::warning, "the daemon at port " + std::to_string(ports_[number]) + " " + how +
                                    (all_[number].restarts.given_up() ? ", and is given up" : "; it is started anew")});
    }

    // One after the other: what one gives back may be enough.
    void bound_memory(Clock::time_point now) {
        next_measure_ = now + measure_interval;
        std::vector<std::optional<ProcessUse>> all;
        for (const auto& one : all_) all.push_back(one.process ? use_of(one.process) : std::nullopt);
        const auto verdict = bound_.look(all, now);
        if (!verdict || std::any_of(all_.begin(), all_.end(), [](const auto& one) { return one.process && one.told; }))
            return;
        auto& one = all_[verdict->number];
        one.told = true;
        tell(one, memory_is_needed);
        if (!wanted_.quiet) log_({LogLevel::warning, words_of(*verdict)});
    }
    std::string words_of(const MemoryBound::Verdict& verdict) const {
        const auto mebibytes = [](std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; };
        return "its daemons hold " + mebibytes(verdict.together) + " together, more than --memory allows (" +
               mebibytes(wanted_.memory) + "): the one at port " + std::to_string(ports_[verdict.number]) +
               ", which holds " + mebibytes(verdict.its) + " and has been idle for " +
               std::to_string(verdict.idle.count()) + " s, is told to end";
    }

    // The only signal that they take, see lightnetd.cpp.
    static void tell(const Daemon& one, int why = 0) {
        sigval said{};
        said.sival_int = why;
        sigqueue(one.process, SIGUSR1, said);
    }
    // Again and again, as one that has just been started doesn't listen to it yet.
    static void tell_and_look(Daemon& one) {
        if (!one.process) return;
        tell(one);
        if (waitpid(one.process, nullptr, WNOHANG) == one.process) forget(one);
    }
    static void forget(Daemon& one) {
        one.process = 0;
        if (one.out >= 0) close(std::exchange(one.out, -1));
    }
    static void wait_for(Daemon& one) {
        while (waitpid(one.process, nullptr, 0) < 0 && errno == EINTR) {
        }
        forget(one);
    }

    const SupervisedDaemons& wanted_;
    const DaemonLog& log_;
    std::string program_, first_;
    std::vector<std::uint16_t> ports_;
    std::vector<Daemon> all_;
    MemoryBound bound_;
    Clock::time_point next_measure_{};
};

}  // namespace

std::vector<std::uint16_t> supervised_ports(const SupervisedDaemons& daemons) {
    const auto parts = tcp_endpoint(daemons.listen).value();
    std::vector<std::uint16_t> ports;
    if (parts.port != "*") {
        const auto first = static_cast<std::uint32_t>(std::stoul(parts.port));
        if (first + daemons.runs - 1 > most_ports)
            throw UserError({"--listen", 0}, "there are no " + std::to_string(daemons.runs) + " ports from " +
                                                 parts.port + " on, one for each of --runs");
        for (std::uint32_t i = 0; i < daemons.runs; ++i) ports.push_back(static_cast<std::uint16_t>(first + i));
        return ports;
    }
    Resolver names;
    const auto address = listening_addresses(parts.host, names).front();
    std::vector<ListeningPort> held;  // so that they differ
    for (std::uint32_t i = 0; i < daemons.runs; ++i) ports.push_back(held.emplace_back(address, 0).port());
    return ports;
}

void supervise(const SupervisedDaemons& wanted, const Signals& signals, const DaemonLog& log) {
    Daemons daemons(wanted, log);
    daemons.start_all();
    log.announce("listening on " + daemons.first());
    for (const auto& at : daemons.metrics()) log.announce("metrics at http://" + at + "/metrics");
    if (!wanted.quiet)
        log({LogLevel::info,
             "serves " + std::to_string(wanted.runs) + " runs at a time, at ports " + daemons.ports_in_words()});
    while (!signals.any) {
        daemons.look_after();
        std::this_thread::sleep_for(look_interval);
    }
    daemons.stop();
}

}  // namespace lightnet
