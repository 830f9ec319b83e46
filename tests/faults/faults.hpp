// What all rows of the table of faults have in common: an undisturbed picture to compare with, programs to disturb, and
// words about what was done and seen.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/faults/rows.hpp"
#include "tests/modes/daemons.hpp"

namespace lightnet::test {

using Words = std::vector<std::string>;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

/// `one`, then `more`.
Words join(Words one, const Words& more);
/// These words, run by a shell that first does `setting`: "ulimit -n 256", say.
Words under(const std::string& setting, const Words& words);
/// How often `word` stands in `text`.
std::size_t times(const std::string& text, const std::string& word);
double seconds_since(Clock::time_point begin);
/// Resident memory in MB; 0: it is gone.
double memory_of(int process);
/// Open descriptors; 0: it is gone.
std::size_t descriptors_of(int process);
/// A place of a hosts file that holds everything.
std::string whole(const std::string& endpoint);

/// A lightnetd that was started in a way of its own. `words` are all of it, or what runs it.
struct OddDaemon {
    explicit OddDaemon(const Words& words);
    ~OddDaemon() {
        if (process) expect_alive(*process);
    }
    OddDaemon(OddDaemon&&) = default;
    std::unique_ptr<Process> process;
    std::string endpoint;  // empty: it listens nowhere
};
Words daemon_words(const std::string& cache, const Words& more = {});

/// A TCP connection that was begun, and says nothing by itself; below 0: there are no descriptors left.
int connect_to(const std::string& endpoint);

/// One row, one test. It says what it does by done() and seen(); a limit of its own ends it.
class Faults : public ::testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    /// The bytes of the picture of graphs/cornell.lua as one thread renders it in peace.
    std::string reference(const Words& picture);
    std::unique_ptr<Process> start(const Words& picture, const Words& more);
    std::string hosts_file(const std::vector<std::string>& places);
    /// A run on the hosts of hosts_file() that is well on its way.
    std::unique_ptr<Process> start_in_the_middle(const Words& picture, const Words& more);
    /// Waits for the end: code 0, the bytes of the reference, every tile counted once. The bytes of its run.json.
    std::string expect_same(Process& run, const Words& picture);
    /// False: the run is over.
    static bool pause(Process& run, milliseconds length);

    void done(const std::string& what) const;
    void seen(const std::string& what) const;
    /// A line for those who collect figures.
    void figure(const std::string& name, double value, const std::string& unit, double goal, bool at_least) const;

    // Of some hundredths of a second, of two, and of eight, on one core.
    static inline const Words brief{"--size", "16x16", "--samples", "4", "--progress", "json"};
    static inline const Words usual{"--size", "64x64", "--samples", "512", "--tile", "16", "--progress", "json"};
    static inline const Words lasting{"--size", "64x64", "--samples", "2048", "--tile", "16", "--progress", "json"};

    Folder folder;
    std::filesystem::path out = folder / "picture.exr";

private:
    const Row* row_ = nullptr;
    std::jthread watch_;
};

/// Ends a row that can't be played here; the table tells why.
#define NOT_RUN(why)                                    \
    do {                                                \
        std::cout << "not run: " << (why) << std::endl; \
        GTEST_SKIP() << (why);                          \
    } while (false)

}  // namespace lightnet::test
