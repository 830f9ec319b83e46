#include "transport/start/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "core/base/error.hpp"

extern char** environ;

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

// Input comes from a file without a name: however long it is, nobody waits for the other.
int file_of(const std::string& text) {
    const int file = memfd_create("input", MFD_CLOEXEC);
    if (file < 0 || write(file, text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
        lseek(file, 0, SEEK_SET) != 0)
        throw Error(std::string("no input for a program: ") + std::strerror(errno));
    return file;
}

std::vector<char*> argv_of(std::vector<std::string>& words) {
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    return argv;
}

pid_t start(std::vector<std::string>& words, std::vector<std::string> more, int in, bool errors_too, int* out) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error(std::string("no pipe to a program: ") + std::strerror(errno));
    const auto argv = argv_of(words);
    std::vector<char*> environment;
    for (auto& word : more) environment.push_back(word.data());
    for (char** word = environ; *word; ++word) environment.push_back(*word);
    environment.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    if (errors_too) posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    if (in >= 0) posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    pid_t process = 0;
    const int error = posix_spawnp(&process, words[0].c_str(), &actions, nullptr, argv.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error) {
        close(ends[0]);
        throw Error(words[0], std::string("can't be started: ") + std::strerror(error));
    }
    *out = ends[0];
    return process;
}

}  // namespace

int spawn_led(std::vector<std::string> words, int* in) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error(std::string("no pipe to a program: ") + std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t process = 0;
    const int error = posix_spawnp(&process, words[0].c_str(), &actions, &attributes, argv_of(words).data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    if (error) {
        close(ends[1]);
        throw Error(words[0], std::string("can't be started: ") + std::strerror(error));
    }
    *in = ends[1];
    return process;
}

int spawn(std::vector<std::string> words, int* out, std::vector<std::string> more) {
    return start(words, std::move(more), -1, false, out);
}

ProgramOutput run_program(std::vector<std::string> words, const std::string& input, std::chrono::milliseconds most) {
    const int in = file_of(input);
    int out = -1;
    pid_t process = 0;
    try {
        process = start(words, {}, in, true, &out);
    } catch (...) {
        close(in);
        throw;
    }
    close(in);
    ProgramOutput said;
    const auto end = Clock::now() + most;
    while (Clock::now() < end) {
        pollfd item{out, POLLIN, 0};
        if (poll(&item, 1, 100) <= 0) continue;
        char buffer[4096];
        const auto n = read(out, buffer, sizeof buffer);
        if (n == 0 || (n < 0 && errno != EINTR)) break;
        if (n > 0) said.text.append(buffer, static_cast<std::size_t>(n));
    }
    close(out);
    if (Clock::now() >= end) kill(process, SIGKILL);
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    said.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return said;
}

}  // namespace lightnet
