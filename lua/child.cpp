#include "lua/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>

#include "core/base/error.hpp"
#include "core/base/patience.hpp"
#include "core/base/spare_threads.hpp"
#include "core/network/graph/value.hpp"

namespace lightnet::lua {
namespace {

using Length = std::uint64_t;  // goes before the text, so that an answer cut short is no answer

/// An end of a pipe.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(); }
    int number() const { return number_; }
    void close() {
        if (number_ >= 0) ::close(number_);
        number_ = -1;
    }

private:
    int number_;
};

/// The child, killed and buried at the latest when this goes.
class Process {
public:
    explicit Process(pid_t id) : id_(id) {}
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process() { end(); }

    /// Its wait status. Killing one that has ended by itself changes nothing.
    int end() {
        if (id_ < 0) return status_;
        ::kill(id_, SIGKILL);
        while (::waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
        }
        id_ = -1;
        return status_;
    }

private:
    pid_t id_;
    int status_ = 0;
};

// DECISIONS: child-with-two-pipes
void limit(__rlimit_resource what, rlim_t most) {
    const rlimit limits{most, most};
    ::setrlimit(what, &limits);
}

void default_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGPROF, SIGXCPU, SIGPIPE}) ::signal(signal, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

// A timer ends the processor time to the millisecond; the kernel's limit, in whole seconds, is the second belt.
void limit_processor(double seconds) {
    const double whole = std::floor(seconds);
    const itimerval once{{0, 0}, {static_cast<time_t>(whole), static_cast<suseconds_t>((seconds - whole) * 1e6)}};
    ::setitimer(ITIMER_PROF, &once, nullptr);
    limit(RLIMIT_CPU, static_cast<rlim_t>(whole) + 1);
}

// Counted from what there is already: of a parent's libraries, or of what a sanitizer has set apart.
void limit_memory(std::size_t more) {
    std::size_t pages = 0;
    if (std::ifstream("/proc/self/statm") >> pages)
        limit(RLIMIT_AS, rlim_t{pages} * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + more);
}

void write_all(int file, const void* data, std::size_t size) {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = ::write(file, at, size);
        if (written < 0 && errno != EINTR) ::_exit(1);
        if (written <= 0) continue;
        at += written;
        size -= static_cast<std::size_t>(written);
    }
}

constexpr int no_descriptors = 4;  // how a child ends that may not even have its pipes

[[noreturn]] void few_descriptors() {
    throw Error("can't be evaluated",
                "this process may open too few file descriptors; a higher limit (ulimit -n) would help");
}

void make_pipe(std::array<int, 2>& ends) {
    if (::pipe2(ends.data(), O_CLOEXEC) == 0) return;
    if (errno == EMFILE) few_descriptors();
    throw Error("can't be evaluated", std::string("no pipe: ") + std::strerror(errno));
}

/// The child's ends of its pipes.
struct Ends {
    int answer, said;
};

[[noreturn]] void be_child(pid_t parent, Ends out, const Budget& budget, const std::function<std::string()>& work) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // it died before we could ask
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    default_signals();
    constexpr int pipe = 3, out_of_the_way = 4;  // who started us may have closed what is usually below that
    const int answer = ::fcntl(out.answer, F_DUPFD, out_of_the_way), said = ::fcntl(out.said, F_DUPFD, out_of_the_way);
    if (answer < 0 || said < 0) ::_exit(no_descriptors);
    ::dup2(said, STDERR_FILENO);
    ::dup2(answer, pipe);
    ::close_range(pipe + 1, ~0U, 0);
    ::close(STDIN_FILENO);
    ::close(STDOUT_FILENO);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit_memory(budget.memory);
    limit_processor(budget.cpu_seconds);
    try {
        const std::string text = work();
        if (text.size() > budget.output) ::_exit(2);
        const Length length = text.size();
        write_all(pipe, &length, sizeof length);
        write_all(pipe, text.data(), text.size());
        ::_exit(0);
    } catch (const std::bad_alloc&) {
        ::_exit(3);
    } catch (const std::exception&) {
        ::_exit(1);  // the parent says that there was no answer
    }
}

/// Passes on what the child says, and so much of it only: it may be talkative.
class Said {
public:
    explicit Said(int in) : in_(in) {}

    /// Of what is there to read. False: no more will come.
    bool pass_on() {
        std::array<char, 4096> buffer;
        const ssize_t size = ::read(in_, buffer.data(), buffer.size());
        if (size <= 0) return size < 0 && errno == EINTR;
        const auto told = std::min(static_cast<std::size_t>(size), room_);
        room_ -= told;
        // what doesn't get through is lost, and no harm done
        if (told > 0 && ::write(STDERR_FILENO, buffer.data(), told) < 0) room_ = 0;
        return true;
    }
    /// When the child is no more.
    void pass_on_rest() {
        while (pass_on()) {
        }
    }
    int number() const { return in_; }

private:
    int in_;
    std::size_t room_ = std::size_t{64} << 10;
};

// Reads to the end of the answer, or until the time or the size is over. False: the time is over.
bool receive(int file, Said& said, const Budget& budget, std::string& text) {
    Patience patience(
        std::chrono::duration_cast<Patience::Clock::duration>(std::chrono::duration<double>(budget.wall_seconds)));
    std::array<char, 65536> buffer;
    std::array<pollfd, 2> ready{pollfd{file, POLLIN, 0}, pollfd{said.number(), POLLIN, 0}};
    while (text.size() <= budget.output + sizeof(Length)) {
        if (patience.is_over()) return false;
        if (::poll(ready.data(), ready.size(), static_cast<int>(patience.until_look().count())) <= 0) continue;
        if (ready[1].revents && !said.pass_on()) ready[1].fd = -1;  // poll() looks at it no more
        if (!ready[0].revents) continue;
        const ssize_t size = ::read(file, buffer.data(), buffer.size());
        if (size == 0) return true;
        if (size > 0)
            text.append(buffer.data(), static_cast<std::size_t>(size));
        else if (errno != EINTR)
            return true;
    }
    return true;
}

[[noreturn]] void no_answer(int status, const Budget& budget) {
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        if (signal == SIGPROF || signal == SIGXCPU)
            throw Error("takes more than " + number_text(budget.cpu_seconds) + " s of processor time");
        throw Error(std::string("its evaluation was ended by a signal: ") + ::strsignal(signal));
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 2)
        throw Error("gives more than " + std::to_string(budget.output >> 20) + " MiB");
    if (WIFEXITED(status) && WEXITSTATUS(status) == no_descriptors) few_descriptors();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 3)
        throw Error("needs more than " + std::to_string(budget.memory >> 20) + " MiB of memory");
    throw Error("its evaluation ended without an answer");
}

}  // namespace

std::string in_child(const Budget& budget, const std::function<std::string()>& work) {
    std::array<int, 2> answer{}, said{};
    make_pipe(answer);
    Descriptor in(answer[0]), out(answer[1]);
    make_pipe(said);
    Descriptor said_in(said[0]), said_out(said[1]);
    const pid_t parent = ::getpid();
    const pid_t id = ::fork();
    if (id < 0)
        throw Error("can't be evaluated",
                    std::string("no process can be started: ") + std::strerror(errno) + "; " + more_threads_help);
    if (id == 0) be_child(parent, {out.number(), said_out.number()}, budget, work);
    Process child(id);
    out.close();
    said_out.close();
    std::string text;
    Said words(said_in.number());
    const bool in_time = receive(in.number(), words, budget, text);
    const int status = child.end();
    words.pass_on_rest();
    if (!in_time)
        throw Error("takes more than " + number_text(budget.wall_seconds) + " s, in which it did not get its " +
                    number_text(budget.cpu_seconds) + " s of processor time: the machine may be busy");
    Length length = 0;
    if (text.size() < sizeof length) no_answer(status, budget);
    std::memcpy(&length, text.data(), sizeof length);
    if (length != text.size() - sizeof length) no_answer(status, budget);
    return text.substr(sizeof length);
}

}  // namespace lightnet::lua
