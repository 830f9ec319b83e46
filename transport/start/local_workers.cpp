#include "transport/start/local_workers.hpp"

#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>
#include <utility>

#include "core/base/allowance.hpp"
#include "core/base/error.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/start/child.hpp"
#include "transport/start/daemon_start.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t starts_per_core = 4;
constexpr const char* any_port = "tcp://127.0.0.1:*";

// The wait status of a process that is over, or is to be.
int end_of(int process) {
    int status = 0;
    kill(process, SIGKILL);  // changes nothing about how it has ended, if it has
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

}  // namespace

int LocalWorkers::start(const std::string& listen, int* out) const {
    std::vector<std::string> words{
        program_, "--listen", listen, "--places", std::to_string(places_), "--parent", std::to_string(getpid())};
    if (!cache_.empty()) words.insert(words.end(), {"--cache", cache_});
    if (!keys_) return spawn(std::move(words), out);
    words.insert(words.end(), {"--allow", keys_->launcher.text()});
    // Nobody but this user reads the environment of a process.
    return spawn(std::move(words), out, {std::string(secret_key_variable) + "=" + keys_->workers.secret_text()});
}

LocalWorkers::LocalWorkers(std::string program, std::uint32_t count, std::uint32_t places, std::optional<Keys> keys,
                           FaultInjection troubles, std::string cache)
    : program_(std::move(program)),
      places_(places),
      keys_(std::move(keys)),
      troubles_(std::move(troubles)),
      cache_(std::move(cache)) {
    if (keys_) keep_secrets_out_of_dumps();
    try {
        start_all(count);
        begin_troubles();
    } catch (...) {
        kill_all();
        throw;
    }
}

// Several together, as each takes a while, but not so many that none gets on.
void LocalWorkers::start_all(std::uint32_t count) {
    const std::size_t together = std::size_t{starts_per_core} * std::max(1u, usable_cores());
    std::vector<int> outs;
    std::size_t heard = 0, started = 0;
    const auto hear_next = [&] {
        started += await_start(workers_[heard], outs[heard]);
        ++heard;
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        if (outs.size() - heard == together) hear_next();
        int out = -1;
        try {
            workers_.push_back({.listens = {}, .endpoint = {}, .process = start(any_port, &out)});
        } catch (const Error&) {  // the system gives no more processes
            if (workers_.empty()) throw;
            break;
        }
        outs.push_back(out);
    }
    while (heard < outs.size()) hear_next();
    workers_.resize(count);
    if (started == 0) throw Error(count == 1 ? "the local worker did not start" : "no local worker has started");
    for (auto& worker : workers_)
        if (worker.listens.empty()) worker.restarts.give_up();
}

// Whom a signal ends (somebody who wants its memory, perhaps) gets another try; whoever ends by itself has said why,
// and would say it again. False: it is given up.
bool LocalWorkers::await_start(Worker& worker, int out) {
    while (true) {
        const auto begun = Clock::now();
        Patience patience(start_patience);
        const auto endpoint = endpoint_said(out, patience);
        close(out);
        if (endpoint) {
            worker.endpoint = worker.listens = *endpoint;
            return true;
        }
        const bool silent = patience.is_over();
        const int status = end_of(std::exchange(worker.process, 0));
        if (silent || !WIFSIGNALED(status)) return false;
        worker.restarts.died(begun, false);
        if (worker.restarts.given_up()) return false;
        worker.process = start(any_port, &out);
    }
}

void LocalWorkers::kill_all() {
    for (auto& worker : workers_) worker.slow.reset();
    for (const auto& worker : workers_)
        if (worker.process) kill(worker.process, SIGKILL);
    for (const auto& worker : workers_)
        if (worker.process) end_of(worker.process);
}

LocalWorkers::~LocalWorkers() {
    for (auto& worker : workers_) worker.slow.reset();
    for (const auto& worker : workers_)
        if (worker.process) kill(worker.process, SIGTERM);
    const auto end = Clock::now() + std::chrono::seconds(1);
    for (const auto& worker : workers_) {
        while (worker.process && waitpid(worker.process, nullptr, WNOHANG) == 0) {
            if (Clock::now() > end) kill(worker.process, SIGKILL);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }
}

std::vector<std::string> LocalWorkers::endpoints() const {
    std::vector<std::string> endpoints;
    for (const auto& worker : workers_)
        if (!worker.endpoint.empty()) endpoints.push_back(worker.endpoint);
    return endpoints;
}

std::size_t LocalWorkers::missing() const {
    return static_cast<std::size_t>(
        std::count_if(workers_.begin(), workers_.end(), [](const Worker& worker) { return worker.endpoint.empty(); }));
}

void LocalWorkers::look_after(Time now, const Handlers& handlers) {
    for (auto& worker : workers_) {
        if (worker.process) {
            worker.was_of_use |= handlers.of_use(worker.endpoint);
            if (waitpid(worker.process, nullptr, WNOHANG) == worker.process) died(worker, now, handlers);
        } else if (worker.restarts.due(now)) {
            int out = -1;
            worker.process = start(worker.listens, &out);
            close(out);  // where it listens is known
            worker.was_of_use = false;
            slow_down(worker);
        }
    }
    lose(handlers.done(), handlers);
}

void LocalWorkers::begin_troubles() {
    for (auto& worker : workers_) {
        if (!worker.process) continue;
        if (troubles_.delay.count() > 0) {
            worker.line = std::make_unique<LatencyProxy>(worker.listens, troubles_.delay);
            worker.endpoint = worker.line->endpoint();
        }
        slow_down(worker);
    }
}

void LocalWorkers::slow_down(Worker& worker) {
    const auto number = static_cast<std::uint32_t>(&worker - workers_.data()) + 1;
    if (const auto found = troubles_.slow.find(number); found != troubles_.slow.end())
        worker.slow = std::make_unique<CpuThrottle>(worker.process, found->second);
}

// Each once: when it has been started anew, it may stay.
void LocalWorkers::lose(double done, const Handlers& handlers) {
    std::erase_if(troubles_.lose, [&](const auto& loss) {
        const auto [number, share] = loss;
        auto& worker = workers_.at(number - 1);
        if (done < share || !worker.process) return false;
        handlers.say("worker" + std::to_string(number) + " (" + worker.endpoint + ") is killed now, as --lose says");
        kill(worker.process, SIGKILL);
        return true;
    });
}

void LocalWorkers::died(Worker& worker, Time now, const Handlers& handlers) {
    worker.process = 0;
    worker.slow.reset();
    handlers.ended(worker.endpoint);
    worker.restarts.died(now, worker.was_of_use);
    if (!worker.restarts.given_up())
        handlers.say("local worker " + worker.endpoint + " has died; it is started anew");
    else
        handlers.say("local worker " + worker.endpoint + " has died " + std::to_string(Restarts::most_useless_deaths) +
                     " times without being of use, and is given up");
}

}  // namespace lightnet
