#include "tests/support/process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

extern char** environ;

namespace lightnet::test {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

namespace {

// The environment of this process, but that sanitizers write what they find into files in `folder`: what is said in the
// output of a process that is killed, or that nobody reads, would be lost.
std::vector<std::string> environment(const std::filesystem::path& folder) {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable; ++variable) variables.emplace_back(*variable);
    for (const std::string name : {"ASAN_OPTIONS", "LSAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"}) {
        const char* before = std::getenv(name.c_str());
        const auto start = name + "=";
        std::erase_if(variables, [&](const auto& variable) { return variable.starts_with(start); });
        variables.push_back(start + (before ? before + std::string(":") : "") +
                            "log_path=" + (folder / "report").string());
    }
    return variables;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

}  // namespace

Process::Process(std::vector<std::string> words) : program_(words[0]) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    auto variables = environment(reports_.path());
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    const int error =
        posix_spawn(&id_, words[0].c_str(), &actions, nullptr, pointers(words).data(), pointers(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    out_ = ends[0];
    if (error) throw std::runtime_error("can't start " + words[0]);
}

Process::~Process() {
    int status = 0;
    if (!ended_ && ::waitpid(id_, &status, WNOHANG) == id_) {
        take(status);
    } else if (!ended_) {
        ::kill(id_, SIGKILL);
        ::waitpid(id_, nullptr, 0);
    }
    close(out_);
    for (const auto& report : std::filesystem::directory_iterator(reports_.path()))
        ADD_FAILURE() << "a sanitizer has found something\n" << bytes_of(report.path());
}

void Process::signal(int number) const {
    signalled_ = true;
    ::kill(id_, number);
}

void Process::take(int status) {
    ended_ = true;
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    constexpr std::array own{SIGABRT, SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGTRAP};
    if (!WIFSIGNALED(status) || signalled_ || std::find(own.begin(), own.end(), WTERMSIG(status)) == own.end()) return;
    while (read_some(milliseconds(0))) {
        pollfd item{out_, POLLIN, 0};
        if (poll(&item, 1, 0) <= 0) break;
    }
    ADD_FAILURE() << program_ << " was ended by its own fault (" << strsignal(WTERMSIG(status)) << ")\n" << output_;
}

bool Process::lives() {
    int status = 0;
    if (!ended_ && ::waitpid(id_, &status, WNOHANG) == id_) take(status);
    return !ended_;
}

bool Process::read_some(milliseconds most) {
    pollfd item{out_, POLLIN, 0};
    if (poll(&item, 1, static_cast<int>(most.count())) <= 0) return true;
    char buffer[4096];
    const auto n = read(out_, buffer, sizeof buffer);
    if (n > 0) output_.append(buffer, static_cast<std::size_t>(n));
    return n > 0;
}

bool Process::wait_for(const std::string& text, milliseconds most) {
    const auto end = Clock::now() + most;
    while (output_.find(text) == std::string::npos) {
        if (Clock::now() > end || !read_some(milliseconds(20))) return output_.find(text) != std::string::npos;
    }
    return true;
}

int Process::wait(milliseconds most) {
    const auto end = Clock::now() + most;
    while (!ended_ && Clock::now() < end) {
        if (!read_some(milliseconds(10))) poll(nullptr, 0, 1);  // closed its outputs; its end is near
        int status = 0;
        if (waitpid(id_, &status, WNOHANG) != id_) continue;
        take(status);
        fcntl(out_, F_SETFL, O_NONBLOCK);
        while (read_some(milliseconds(0))) {
            pollfd item{out_, POLLIN, 0};
            if (poll(&item, 1, 0) <= 0) break;
        }
    }
    return code_;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in) << file << " is not there";
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}

std::vector<int> processes_with(const std::string& text) {
    std::vector<int> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        const auto name = entry.path().filename().string();
        if (!std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; })) continue;
        std::ifstream in(entry.path() / "cmdline", std::ios::binary);
        std::string line((std::istreambuf_iterator<char>(in)), {});
        std::replace(line.begin(), line.end(), '\0', ' ');
        if (line.find(text) != std::string::npos && std::stoi(name) != getpid()) found.push_back(std::stoi(name));
    }
    return found;
}

}  // namespace lightnet::test
