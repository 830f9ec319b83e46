// A nemesis: runs on daemons whose processes are killed and stopped, whose lines are cut and held, whose caches go,
// whose launcher's disk is full, all mixed at random, most of it while a run begins or ends. What comes of each run is
// the bytes of an undisturbed one, or a promised exit code after which --resume gives these bytes; daemons that were
// not killed are alive; nothing is left behind. LIGHTNET_NEMESIS_SECONDS: how long (120; a soak: 7200).
// LIGHTNET_NEMESIS_SEED: what happens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/prctl.h>
#include <sys/wait.h>

#include <csignal>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <random>

#include "tests/faults/small_disk.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/support/bad_line.hpp"

namespace lightnet::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Words = std::vector<std::string>;

const Words picture_words{"--size", "64x64", "--samples", "256", "--tile", "16", "--progress", "json"};

/// Chance, told by a seed.
class Chance {
public:
    explicit Chance(std::uint64_t seed) : source_(seed) {}
    std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(source_); }
    milliseconds between(int least, int most) {
        return milliseconds(least + int(below(std::size_t(most - least + 1))));
    }

private:
    std::mt19937_64 source_;
};

/// A daemon behind a line that can be hurt. Who is killed comes back at another port, behind another line.
struct Host {
    explicit Host(const Folder& cache) : folder(cache) { start(); }
    void start() {
        daemon = std::make_unique<Daemon>(folder);
        line = std::make_unique<BadLine>(daemon->endpoint);
        killed = false;
    }
    const Folder& folder;
    std::unique_ptr<Daemon> daemon;
    std::unique_ptr<BadLine> line;
    bool killed = false;
};

/// One thing that is done to a run, and what undoes it later.
struct Blow {
    std::string what;
    std::function<void()> strike, undo;
    milliseconds lasts{0};
};

/// When it comes: most come while a run begins or ends.
enum class Phase { beginning, middle, end };

std::vector<int> children() {
    std::ifstream in("/proc/self/task/" + std::to_string(getpid()) + "/children");
    std::vector<int> all;
    for (int child = 0; in >> child;) all.push_back(child);
    return all;
}

class Nemesis : public ::testing::Test {
protected:
    static seconds length() {
        const char* const text = std::getenv("LIGHTNET_NEMESIS_SECONDS");
        return seconds(text ? std::atoi(text) : 120);
    }
    static std::uint64_t seed() {
        const char* const text = std::getenv("LIGHTNET_NEMESIS_SEED");
        return text ? std::strtoull(text, nullptr, 10) : std::random_device{}();
    }

    void SetUp() override {
        ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // what runs leave behind comes to us
        ::setenv("TMPDIR", shed_.path().c_str(), 1);
        const auto peace = launch(graph_file("cornell.lua"), peace_, picture_of({"--threads", "1"}), seconds(300));
        ASSERT_EQ(peace.code, 0) << peace.said;
        reference_ = peace.picture;
        for (const Folder& cache : caches_) hosts_.push_back(std::make_unique<Host>(cache));
    }
    void TearDown() override { ::unsetenv("TMPDIR"); }

    static fs::path picture_in(const Folder& folder) { return folder / "there" / "pictures" / "picture.exr"; }
    static Words picture_of(Words more) {
        more.insert(more.begin(), picture_words.begin(), picture_words.end());
        return more;
    }

    // One run, with blows.
    void round(Chance& chance) {
        for (auto& host : hosts_)
            if (host->killed) host->start();
        const Folder folder;
        std::optional<SmallDisk> disk;
        if (SmallDisk::obstacle().empty()) disk.emplace(picture_in(folder).parent_path(), 8192);
        disk_ = disk ? &*disk : nullptr;
        fs::create_directories(picture_in(folder).parent_path());
        const bool with_a_worker = chance.below(3) == 0;
        Words more{"--hosts", hosts_file(folder, chance), "--checkpoint", "1", "--wait", "20"};
        if (with_a_worker) more.insert(more.end(), {"--local-workers", "1"});
        told_ = with_a_worker ? "with a worker" : "on hosts";
        const auto before = children();
        int code = 0;
        std::string said;
        {
            Process run(launch_words(graph_file("cornell.lua"), picture_in(folder), picture_of(more)));
            launcher_killed_ = interrupted_ = false;
            strike(run, chance, folder);
            code = run.wait(slowdown * seconds(120));
            said = run.output();
        }
        judge(folder, code, said);
        if (HasFailure()) return;
        if (code != 0) resume(folder);
        expect_nothing_left(folder, before, said);
        for (std::size_t i = 0; i < hosts_.size(); ++i)
            if (!hosts_[i]->killed) {
                EXPECT_LT(hosts_[i]->daemon->process->wait(milliseconds(1)), 0) << "daemon " << i << " has died\n"
                                                                                << hosts_[i]->daemon->process->output();
            }
        codes_[launcher_killed_ ? "killed" : std::to_string(code)] += 1;
    }

    // Blows one after the other, each in a phase of its own.
    void strike(Process& run, Chance& chance, const Folder& folder) {
        const std::size_t count = 1 + chance.below(4);
        std::vector<std::pair<Clock::time_point, std::function<void()>>> undoing;
        const auto settle = [&](Clock::time_point now) {
            std::erase_if(undoing, [&](const auto& one) {
                if (one.first > now) return false;
                one.second();
                return true;
            });
        };
        for (std::size_t i = 0; i < count; ++i) {
            await(run, phase(chance), chance);
            if (run.wait(milliseconds(1)) >= 0) break;
            Blow blow = some_blow(run, chance, folder);
            told_ += ", " + blow.what;
            blow.strike();
            if (blow.undo) undoing.emplace_back(Clock::now() + blow.lasts, blow.undo);
            settle(Clock::now());
        }
        while (!undoing.empty()) {
            run.wait_for("never said", milliseconds(20));
            settle(Clock::now());
        }
        if (disk_) disk_->clear();  // its folder may have been away when it was to be
    }

    static Phase phase(Chance& chance) {
        const auto drawn = chance.below(10);
        return drawn < 4 ? Phase::beginning : drawn < 8 ? Phase::end : Phase::middle;
    }

    // At the beginning: within the first fractions of a second. At the end: when the last tiles come, or thereafter.
    static void await(Process& run, Phase phase, Chance& chance) {
        if (phase != Phase::beginning) run.wait_for("\"event\":\"progress\"", seconds(20));
        if (phase == Phase::end) run.wait_for(chance.below(2) ? "\"done\":256," : "\"event\":\"finish\"", seconds(20));
        run.wait_for("never said", phase == Phase::end ? chance.between(0, 60) : chance.between(0, 400));
    }

    static fs::path away(const Folder& folder) { return folder / "away"; }

    Blow some_blow(Process& run, Chance& chance, const Folder& folder) {
        const std::size_t number = chance.below(hosts_.size());
        Host& host = *hosts_[number];
        const auto name = " of " + std::to_string(number);
        const auto stopped = [&](const char* what, int process) {
            return Blow{what, [process] { ::kill(process, SIGSTOP); }, [process] { ::kill(process, SIGCONT); },
                        chance.between(50, 5000)};
        };
        switch (chance.below(10)) {
            case 0:
                return {"killed the daemon" + name,
                        [&host] {
                            host.daemon->process->signal(SIGKILL);
                            host.killed = true;
                        },
                        {}};
            case 1:
                return stopped("stopped a daemon", host.daemon->process->id());
            case 2:
                return stopped("stopped the launcher", run.id());
            case 3:
                return {"cut the line" + name, [&host] { host.line->cut(); }, {}};
            case 4:
                return {"held the line" + name, [&host] { host.line->hold(true); }, [&host] { host.line->hold(false); },
                        chance.between(50, 4000)};
            case 5:
                return {"took the cache" + name,
                        [&host] {
                            std::error_code ignored;
                            for (const auto& file : fs::directory_iterator(host.folder / "cache", ignored))
                                fs::remove_all(file.path(), ignored);
                        },
                        {}};
            case 6:
                return {"killed the launcher",
                        [&] {
                            run.signal(SIGKILL);
                            launcher_killed_ = true;
                        },
                        {}};
            case 7:
                return {"told the launcher to end",
                        [&run, this, hang = chance.below(2) == 0] {
                            run.signal(hang ? SIGHUP : SIGTERM);
                            interrupted_ = true;
                        },
                        {}};
            case 8:
                if (disk_)
                    return {"filled the picture's disk", [disk = disk_] { disk->leave(0); },
                            [disk = disk_] { disk->clear(); }, chance.between(50, 3000)};
                [[fallthrough]];
            default: {
                return {"took the picture's folder",
                        [&folder] {
                            std::error_code gone_already;
                            fs::rename(folder / "there", away(folder), gone_already);
                        },
                        [&folder] {
                            std::error_code back_already;
                            fs::rename(away(folder), folder / "there", back_already);
                        },
                        chance.between(50, 3000)};
            }
        }
    }

    void judge(const Folder& folder, int code, const std::string& said) const {
        const auto story = told_ + "\nended with " + std::to_string(code) + "\n" + said;
        const auto out = picture_in(folder);
        if (code == 2) {
            EXPECT_NE(said.find("there is no folder"), std::string::npos) << "it was taken at the beginning: " << story;
        } else if (launcher_killed_) {
            EXPECT_THAT(code, testing::AnyOf(0, 128 + SIGKILL, 1, 130)) << story;
        } else if (interrupted_ && said.empty()) {
            // It was told before it could listen: then the system ends it, and nothing has begun.
            EXPECT_THAT(code, testing::AnyOf(130, 128 + SIGTERM, 128 + SIGHUP)) << story;
            EXPECT_FALSE(fs::exists(out)) << story;
        } else if (interrupted_) {
            EXPECT_THAT(code, testing::AnyOf(0, 1, 3, 130)) << story;
        } else {
            EXPECT_THAT(code, testing::AnyOf(0, 1, 3)) << story;
        }
        EXPECT_TRUE(code == 0 || code >= 128 || !said.empty()) << "it fails without a word: " << story;
        if (code == 0) {
            EXPECT_TRUE(fs::exists(out) && bytes_of(out) == reference_) << "other bytes: " << story;
        } else if (fs::exists(out) && said.find("cancelled") == std::string::npos) {
            EXPECT_GT(fs::file_size(out), 0u) << story;
        }
    }

    // Whatever happened, the picture can be had.
    void resume(const Folder& folder) const {
        const auto out = picture_in(folder);
        Process run(launch_words(graph_file("cornell.lua"), out, picture_of({"--threads", "2", "--resume"})));
        const int code = run.wait(slowdown * seconds(180));
        EXPECT_EQ(code, 0) << told_ << "\n--resume ended with " << code << "\n" << run.output();
        EXPECT_TRUE(code != 0 || bytes_of(out) == reference_) << "other bytes after --resume: " << told_;
    }

    void expect_nothing_left(const Folder& folder, const std::vector<int>& before, const std::string& said) const {
        const auto end = Clock::now() + slowdown * seconds(10);
        auto now = children();
        for (; now.size() > before.size() && Clock::now() < end; now = children()) {
            for (const int child : now)
                if (std::find(before.begin(), before.end(), child) == before.end()) ::waitpid(child, nullptr, WNOHANG);
            std::this_thread::sleep_for(milliseconds(20));
        }
        EXPECT_LE(now.size(), before.size()) << "processes are left behind: " << told_;
        for (const auto& entry : fs::directory_iterator(picture_in(folder).parent_path())) {
            const auto name = entry.path().filename().string();
            EXPECT_EQ(name.find(".part"), std::string::npos) << "left behind: " << name << ": " << told_;
        }
        for (const auto& entry : fs::directory_iterator(shed_.path())) {
            const auto name = entry.path().filename().string();
            const bool ours = name.starts_with("lightnet-test-");
            EXPECT_TRUE(ours || launcher_killed_ || said.find(name) != std::string::npos)
                << "left behind without a word: " << name << ": " << told_;
            if (!ours) fs::remove_all(entry.path());  // it was said, and is not the next run's
        }
    }

    std::string hosts_file(const Folder& folder, Chance& chance) const {
        std::string text;
        const bool spread = chance.below(2) == 0;
        for (std::size_t i = 0; i < hosts_.size(); ++i)
            text += "place '" + hosts_[i]->line->endpoint() + "' {" +
                    (!spread      ? ""
                     : i % 2 == 0 ? " image = 1, direct = 1, lighting = 1 "
                                  : " image = 1, bounce = 1 ") +
                    "}\n";
        return folder.write("hosts.lua", text);
    }

    std::map<std::string, int> codes_;
    std::string told_;

private:
    Folder shed_, peace_;
    std::array<Folder, 3> caches_;
    std::vector<std::unique_ptr<Host>> hosts_;
    std::string reference_;
    SmallDisk* disk_ = nullptr;
    bool launcher_killed_ = false, interrupted_ = false;
};

TEST_F(Nemesis, FindsNothingThatARunDoesNotGetOver) {
    const auto drawn = seed();
    Chance chance(drawn);
    std::cout << "LIGHTNET_NEMESIS_SEED=" << drawn << std::endl;
    int rounds = 0;
    for (const auto end = Clock::now() + length(); Clock::now() < end && !HasFailure(); ++rounds) {
        round(chance);
        std::cout << rounds << ": " << told_ << std::endl;
    }
    std::cout << rounds << " runs, ended with";
    for (const auto& [code, count] : codes_) std::cout << " " << code << ": " << count;
    std::cout << std::endl;
    EXPECT_GE(rounds, 2);
}

}  // namespace
}  // namespace lightnet::test
