#include "transport/start/local_workers.hpp"

#include <sys/wait.h>
#include <unistd.h>
#include <chrono>
#include <csignal>
#include <thread>

#include <poll.h>

#include "core/base/error.hpp"
#include "transport/keys/key_file.hpp"
#include "transport/start/child.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int most_useless_deaths = 5;
constexpr auto first_delay = std::chrono::milliseconds(50);  // before a worker is started anew; doubles

// The first line of a daemon: "listening on ENDPOINT".
std::string read_endpoint(int in) {
    std::string line;
    const auto end = Clock::now() + std::chrono::seconds(20);
    while (line.find('\n') == std::string::npos && Clock::now() < end) {
        pollfd item{in, POLLIN, 0};
        if (poll(&item, 1, 200) <= 0) continue;
        char buffer[256];
        const auto n = read(in, buffer, sizeof buffer);
        if (n <= 0) break;
        line.append(buffer, static_cast<std::size_t>(n));
    }
    const std::string before = "listening on ";
    const auto at = line.find(before);
    if (at == std::string::npos) throw Error("a local worker did not start");
    return line.substr(at + before.size(), line.find('\n', at) - at - before.size());
}

}  // namespace

int LocalWorkers::start(const std::string& listen, int* out) const {
    std::vector<std::string> words{
        program_, "--listen", listen, "--places", std::to_string(places_), "--parent", std::to_string(getpid())};
    if (!keys_) return spawn(std::move(words), out);
    words.insert(words.end(), {"--allow", keys_->launcher.text()});
    // Nobody but this user reads the environment of a process.
    return spawn(std::move(words), out, {std::string(secret_key_variable) + "=" + keys_->workers.secret_text()});
}

LocalWorkers::LocalWorkers(std::string program, std::uint32_t count, std::uint32_t places, std::optional<Keys> keys,
                           Troubles troubles)
    : program_(std::move(program)), places_(places), keys_(std::move(keys)), troubles_(std::move(troubles)) {
    if (keys_) keep_secrets_out_of_dumps();
    std::vector<int> outs;
    try {
        for (std::uint32_t i = 0; i < count; ++i) {  // all start together
            int out = -1;
            workers_.push_back({.listens = {}, .endpoint = {}, .process = start("tcp://127.0.0.1:*", &out)});
            outs.push_back(out);
        }
        for (std::uint32_t i = 0; i < count; ++i) workers_[i].endpoint = workers_[i].listens = read_endpoint(outs[i]);
        begin_troubles();
    } catch (...) {
        for (const auto out : outs) close(out);
        for (auto& worker : workers_) worker.slow.reset();
        for (const auto& worker : workers_) kill(worker.process, SIGKILL);
        for (const auto& worker : workers_) waitpid(worker.process, nullptr, 0);
        throw;
    }
    for (const auto out : outs) close(out);
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
    for (const auto& worker : workers_) endpoints.push_back(worker.endpoint);
    return endpoints;
}

void LocalWorkers::look_after(Time now, const Handlers& handlers) {
    for (auto& worker : workers_) {
        if (worker.process) {
            worker.was_of_use |= handlers.of_use(worker.endpoint);
            if (waitpid(worker.process, nullptr, WNOHANG) == worker.process) died(worker, now, handlers);
        } else if (worker.useless_deaths < most_useless_deaths && now >= worker.next_start) {
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
        if (troubles_.delay.count() > 0) {
            worker.line = std::make_unique<DelayLine>(worker.listens, troubles_.delay);
            worker.endpoint = worker.line->endpoint();
        }
        slow_down(worker);
    }
}

void LocalWorkers::slow_down(Worker& worker) {
    const auto number = static_cast<std::uint32_t>(&worker - workers_.data()) + 1;
    if (const auto found = troubles_.slow.find(number); found != troubles_.slow.end())
        worker.slow = std::make_unique<SlowMotion>(worker.process, found->second);
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
    worker.useless_deaths = worker.was_of_use ? 0 : worker.useless_deaths + 1;
    worker.next_start = now + first_delay * (1 << worker.useless_deaths);
    if (worker.useless_deaths < most_useless_deaths)
        handlers.say("local worker " + worker.endpoint + " has died; it is started anew");
    else
        handlers.say("local worker " + worker.endpoint + " has died " + std::to_string(most_useless_deaths) +
                     " times without being of use, and is given up");
}

}  // namespace lightnet
