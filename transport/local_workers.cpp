#include "transport/local_workers.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include <poll.h>

#include "core/error.hpp"

extern char** environ;

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

// Starts a program whose standard output comes back through `*out`.
pid_t spawn(std::vector<std::string> words, int* out) {
    int ends[2];
    if (pipe(ends) != 0) throw Error(std::string("no pipe to a worker: ") + std::strerror(errno));
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    pid_t process = 0;
    const int error = posix_spawn(&process, words[0].c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error) {
        close(ends[0]);
        throw Error(words[0], std::string("can't be started: ") + std::strerror(error));
    }
    *out = ends[0];
    return process;
}

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

LocalWorkers::LocalWorkers(const std::string& program, std::uint32_t count, std::uint32_t places) {
    for (std::uint32_t i = 0; i < count; ++i) {
        int out = -1;
        processes_.push_back(spawn({program, "--listen", "tcp://127.0.0.1:*", "--places", std::to_string(places),
                                    "--parent", std::to_string(getpid())},
                                   &out));
        try {
            endpoints_.push_back(read_endpoint(out));
            close(out);
        } catch (...) {
            close(out);
            for (const auto process : processes_) kill(process, SIGKILL);
            for (const auto process : processes_) waitpid(process, nullptr, 0);
            throw;
        }
    }
}

LocalWorkers::~LocalWorkers() {
    for (const auto process : processes_)
        if (process) kill(process, SIGTERM);
    const auto end = Clock::now() + std::chrono::seconds(1);
    for (const auto process : processes_) {
        while (process && waitpid(process, nullptr, WNOHANG) == 0) {
            if (Clock::now() > end) kill(process, SIGKILL);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }
}

std::vector<std::string> LocalWorkers::ended() {
    std::vector<std::string> ended;
    for (std::size_t i = 0; i < processes_.size(); ++i)
        if (processes_[i] && waitpid(processes_[i], nullptr, WNOHANG) == processes_[i]) {
            processes_[i] = 0;
            ended.push_back(endpoints_[i]);
        }
    return ended;
}

}  // namespace lightnet
