// `lightnetd --metrics`: what a daemon tells Prometheus.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "tests/modes/daemons.hpp"
#include "tools/daemon/metrics.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Metrics : public ::testing::Test {
protected:
    Metrics() : daemon(folder, 2, "tcp://127.0.0.1:*", {"--metrics", "127.0.0.1:0"}) {
        const std::string before = "metrics at http://127.0.0.1:";
        EXPECT_TRUE(daemon.process->wait_for("/metrics")) << daemon.process->output();
        const auto& said = daemon.process->output();
        const auto at = said.find(before);
        if (at != std::string::npos) port = static_cast<std::uint16_t>(std::atoi(said.c_str() + at + before.size()));
    }

    /// Whatever is answered until the connection is closed.
    std::string ask(const std::string& request) const {
        const int line = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in to{};
        to.sin_family = AF_INET, to.sin_port = htons(port), to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(line, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
        EXPECT_EQ(::send(line, request.data(), request.size(), MSG_NOSIGNAL), static_cast<ssize_t>(request.size()));
        std::string answer(1 << 16, '\0');
        std::size_t size = 0;
        for (ssize_t more = 1; more > 0 && size < answer.size();
             size += static_cast<std::size_t>(std::max<ssize_t>(0, more)))
            more = ::recv(line, answer.data() + size, answer.size() - size, 0);
        ::close(line);
        answer.resize(size);
        return answer;
    }
    std::string own() const { return "127.0.0.1:" + std::to_string(port); }
    std::string metrics() const {
        const auto answer = ask("GET /metrics HTTP/1.1\r\nHost: " + own() + "\r\n\r\n");
        EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
        const auto body = answer.find("\r\n\r\n");
        return body == std::string::npos ? "" : answer.substr(body + 4);
    }
    static double value_of(const std::string& text, const std::string& name) {
        const auto at = text.find("\nlightnet_" + name + " ");
        EXPECT_NE(at, std::string::npos) << name;
        return at == std::string::npos ? -1 : std::atof(text.c_str() + at + name.size() + 11);
    }
    // Figures of a run that is over come a moment later: first those that move while it runs, such as rays, then those
    // of runs that have ended, such as tiles.
    std::string metrics_with(const std::string& name, double least) const {
        const auto end = std::chrono::steady_clock::now() + slowdown * std::chrono::seconds(30);
        auto text = metrics();
        while (value_of(text, name) < least && std::chrono::steady_clock::now() < end) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            text = metrics();
        }
        return text;
    }
    void render() const {
        const auto hosts = folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}\n");
        const auto run =
            launch(graph_file("cornell.lua"), folder, {"--size", "32x32", "--samples", "16", "--hosts", hosts});
        EXPECT_EQ(run.code, 0) << run.said;
    }

    const Folder folder;
    const Daemon daemon;
    std::uint16_t port = 0;
};

TEST_F(Metrics, CountWhatADaemonDoes) {
    const auto before = metrics_with("places", 2);
    EXPECT_EQ(value_of(before, "places"), 2);
    EXPECT_EQ(value_of(before, "serving"), 0);
    EXPECT_EQ(value_of(before, "runs_total"), 0);
    render();
    const auto after = metrics_with("tiles_total", 1);
    EXPECT_EQ(value_of(after, "runs_total"), 1);
    EXPECT_GT(value_of(after, "rays_total"), 32 * 32 * 16);
    EXPECT_GT(value_of(after, "answered_total"), 0);
    EXPECT_GT(value_of(after, "busy_seconds_total"), 0);
    const double rays = value_of(after, "rays_total"), tiles = value_of(after, "tiles_total");
    render();
    EXPECT_EQ(value_of(metrics_with("tiles_total", tiles + 1), "rays_total"), 2 * rays) << "they only grow";
}

TEST_F(Metrics, MoveWhileARunRuns) {
    const auto hosts = folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}\n");
    Process run(launch_words(graph_file("cornell.lua"), folder / "long.exr",
                             {"--size", "64x64", "--samples", "1000000", "--tile", "16", "--hosts", hosts}));
    const auto first = metrics_with("rays_total", 1);
    EXPECT_EQ(value_of(first, "serving"), 1);
    const auto second = metrics_with("rays_total", value_of(first, "rays_total") + 1);
    EXPECT_EQ(value_of(second, "serving"), 1) << "it is still the same run";
    EXPECT_GT(value_of(second, "rays_total"), value_of(first, "rays_total"));
    EXPECT_GT(value_of(second, "busy_seconds_total"), 0);
    const double rays = value_of(second, "rays_total");
    run.signal(SIGTERM);
    run.wait();
    EXPECT_GE(value_of(metrics_with("rays_total", rays), "rays_total"), rays) << "they only grow";
}

TEST_F(Metrics, TellWhatTheProcessTakes) {
    const auto text = metrics();
    for (const char* name : {"process_resident_memory_bytes", "process_virtual_memory_bytes", "process_open_fds",
                             "process_max_fds", "process_start_time_seconds", "process_cpu_seconds_total"}) {
        const auto at = text.find(std::string("\n") + name + " ");
        ASSERT_NE(at, std::string::npos) << name;
        EXPECT_GT(std::atof(text.c_str() + at + std::strlen(name) + 2), 0) << name;
    }
}

TEST_F(Metrics, SayWhetherItCanTakeWork) {
    metrics_with("places", 2);  // it serves
    const auto well = ask("GET /healthz HTTP/1.1\r\nHost: " + own() + "\r\n\r\n");
    EXPECT_THAT(well, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(well, HasSubstr("\r\n\r\nok\n"));
}

TEST(Fitness, IsThatOfItsThreadAndOfNobodyElse) {
    using namespace std::chrono_literals;
    const auto now = std::chrono::steady_clock::now();
    DaemonFigures figures;
    EXPECT_EQ(why_unfit(figures, now), "it does not serve yet");
    figures.when = now;
    EXPECT_EQ(why_unfit(figures, now + 1s), "");
    figures.serves = true;
    EXPECT_EQ(why_unfit(figures, now + 1s), "") << "a run is no illness";
    EXPECT_EQ(why_unfit(figures, now + 60s), "the thread that serves is stuck");
    figures.leaves = true;
    EXPECT_EQ(why_unfit(figures, now), "it was told to stop");
}

TEST_F(Metrics, AreAsPrometheusWantsThem) {
    Process which({"/usr/bin/env", "promtool", "--version"});
    if (which.wait() != 0) GTEST_SKIP() << "promtool, of Debian's package prometheus, is not here";
    render();
    const auto file = folder.write("metrics.txt", metrics_with("rays_total", 1));
    Process check({"/bin/sh", "-c", "promtool check metrics < " + file});
    EXPECT_EQ(check.wait(), 0) << check.output();
    EXPECT_EQ(check.output(), "") << "nor has it advice";
}

TEST_F(Metrics, RefuseWhatIsNoQuestionForThem) {
    EXPECT_THAT(ask("GET / HTTP/1.1\r\nHost: " + own() + "\r\n\r\n"), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(ask("POST /metrics HTTP/1.1\r\nHost: " + own() + "\r\nContent-Length: 0\r\n\r\n"),
                StartsWith("HTTP/1.1 405"));
    EXPECT_THAT(ask("what do you do?\r\n\r\n"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(ask("GET /" + std::string(9000, 'x') + " HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 431"));
    EXPECT_THAT(ask("HEAD /metrics HTTP/1.1\r\nHost: " + own() + "\r\n\r\n"), StartsWith("HTTP/1.1 200"));
    EXPECT_EQ(value_of(metrics(), "serving"), 0) << "it is still there";
}

// As of a page whose name leads here by now.
TEST_F(Metrics, AreToldOnlyToWhoCallsThisMachineByItsName) {
    const auto status = [&](const std::string& headers) {
        return ask("GET /metrics HTTP/1.1\r\n" + headers + "\r\n").substr(9, 3);
    };
    EXPECT_EQ(status("Host: localhost:" + std::to_string(port) + "\r\n"), "200");
    EXPECT_EQ(status(""), "400");
    EXPECT_EQ(status("Host: evil.example:" + std::to_string(port) + "\r\n"), "421");
    EXPECT_EQ(status("Host: " + own() + "\r\nHost: evil.example\r\n"), "400");
    EXPECT_EQ(status("Host: " + own() + "\r\nOrigin: http://evil.example\r\n"), "403");
}

TEST(MetricsOptions, GoBeyondThisMachineOnlyWhenThatIsSaid) {
    Process refused({program("lightnetd"), "--metrics", "0.0.0.0:0"});
    EXPECT_EQ(refused.wait(), 2);
    EXPECT_THAT(refused.output(), HasSubstr("--insecure"));
    Process wrong({program("lightnetd"), "--metrics", "127.0.0.1:x"});
    EXPECT_EQ(wrong.wait(), 2);
    EXPECT_THAT(wrong.output(), HasSubstr("takes an address like 127.0.0.1:9100"));
}

}  // namespace
}  // namespace lightnet::test
