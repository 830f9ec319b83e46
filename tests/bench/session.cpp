// Time from an edit to the first picture of a session: one sample per pixel, written to its files. Edits of the camera,
// of a node and of the scene, on two threads and on two daemons.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/base/json.hpp"
#include "tests/bench/figure.hpp"
#include "tests/support/folder.hpp"

namespace {

using namespace std::chrono_literals;
namespace bench = lightnet::bench;

const int edits = bench::sized(40, 2);
constexpr double goal = 60;  // ms, for the slowest of twenty edits

/// A session whose edits go through a pipe with a name.
class Session {
public:
    explicit Session(const std::string& layout) {
        const std::string pipe = folder_.file("edits");
        if (::mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
        const auto command = fmt::format(
            "exec '{}' session '{}/graphs/cornell.lua' {} --size {} -D samples=1000 --cache none --json -o '{}' <'{}'",
            LIGHTNET_STARTS_LIGHTNET, LIGHTNET_SOURCE_DIR, layout, bench::sized("256x256", "16x16"),
            folder_.file("now.exr"), pipe);
        events_.reset(::popen(command.c_str(), "r"));
        edits_ = ::open(pipe.c_str(), O_WRONLY | O_CLOEXEC);
        wait_for_picture(0);
    }
    ~Session() {
        say(R"({"constants":{"samples":1},"end":true})");
        ::close(edits_);
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    void say(const std::string& edit) const {
        const std::string line = edit + "\n";
        if (::write(edits_, line.data(), line.size()) != ssize_t(line.size())) throw std::runtime_error("it is gone");
    }
    // The first one of an edit.
    void wait_for_picture(std::uint64_t edit) {
        for (std::string line; next(line);) {
            const auto event = lightnet::parse_json(line);
            if (event.at("event").text() == "error") throw std::runtime_error(line);
            if (event.at("event").text() == "picture" && event.at("edit").whole<std::uint64_t>() == edit) return;
        }
        throw std::runtime_error("the session has ended");
    }

private:
    struct Closes {
        void operator()(std::FILE* file) const { ::pclose(file); }
    };
    bool next(std::string& line) {
        line.clear();
        for (int c = std::getc(events_.get()); c != EOF && c != '\n'; c = std::getc(events_.get())) line += char(c);
        return !line.empty();
    }

    lightnet::test::Folder folder_;
    std::unique_ptr<std::FILE, Closes> events_;
    int edits_ = -1;
};

std::string edit_of(const std::string& kind, int number) {
    if (kind == "camera")
        return fmt::format(R"({{"camera":{{"from":[{},273,-800],"to":[278,273,280]}}}})", 200 + number);
    if (kind == "node") return fmt::format(R"({{"set":{{"direct.samples":{}}}}})", 1 + number % 2);
    return fmt::format(R"({{"set":{{"scene.environment_scale":{}}}}})", 1 + number);
}

// Each edit comes while the picture of the one before is at work.
void measure(const std::string& name, const std::string& layout) {
    for (const std::string kind : {"camera", "node", "scene"}) {
        Session session(layout);
        std::vector<double> times;
        for (int i = 0; i < edits; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50 + 37 * i % 100));
            session.say(edit_of(kind, i));
            times.push_back(1000 * bench::seconds_of([&] { session.wait_for_picture(std::uint64_t(i) + 1); }));
        }
        std::sort(times.begin(), times.end());
        const auto at = [&](double part) { return times[std::size_t(part * double(times.size() - 1))]; };
        std::printf("  %s, %s: p50 %.0f ms, p95 %.0f, p99 %.0f\n", name.c_str(), kind.c_str(), at(0.5), at(0.95),
                    at(0.99));
        bench::print_figure("session " + name + " " + kind, {at(0.95)}, {"", "ms ", 1, 0}, goal, false);
    }
}

}  // namespace

int main() {
    return bench::run("session", [] {
        measure("threads", "--threads 2");
        measure("daemons", "--local-workers 2");
    });
}
