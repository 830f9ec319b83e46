// Programs as users run them: started, watched, hurt.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/folder.hpp"
#include "tests/support/slowdown.hpp"

namespace lightnet::test {

/// A child process whose output is collected. Killed, with a grudge, when the object ends first. Whatever a sanitizer
/// finds in it, or in processes that it starts, fails the test: a run gets over the loss of a worker, a test must not.
/// So does a process that aborts, or is ended by a fault of its own.
class Process {
public:
    explicit Process(std::vector<std::string> words);
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    int id() const { return id_; }
    void signal(int number) const;
    /// Has it not ended yet?
    bool lives();
    /// Has anybody waited for its end, or sent it a signal?
    bool was_expected_to_end() const { return ended_ || signalled_; }
    int code() const { return code_; }
    /// Reads output until it holds `text`. False: the process ended, or `most` passed, before it did.
    bool wait_for(const std::string& text, std::chrono::milliseconds most = slowdown * std::chrono::seconds(20));
    /// Waits for the end: the exit code, 128 + signal if one ended it, -1 if it still runs after `most`.
    int wait(std::chrono::milliseconds most = slowdown * std::chrono::seconds(60));
    /// What it has said so far, to both outputs.
    const std::string& output() const { return output_; }

private:
    bool read_some(std::chrono::milliseconds most);
    void take(int status);
    std::string program_;
    Folder reports_;  // of sanitizers
    int id_ = 0, out_ = -1;
    bool ended_ = false;
    mutable bool signalled_ = false;
    int code_ = -1;
    std::string output_;
};

/// All bytes of a file; fails the test when there is none.
std::string bytes_of(const std::filesystem::path& file);

/// Processes of this user whose command line holds `text`.
std::vector<int> processes_with(const std::string& text);

}  // namespace lightnet::test
