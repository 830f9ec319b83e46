#include "tests/faults/faults.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <mutex>
#include <stop_token>

namespace lightnet::test {
namespace {

// Where pictures in peace are kept for the rows to come; empty: nowhere.
std::filesystem::path shelf() {
    const char* const folder = std::getenv("LIGHTNET_FAULTS_SHELF");
    return folder ? folder : "";
}

std::string joined(const Words& words) {
    std::string all;
    for (const auto& word : words) all += word + ' ';
    return all;
}

// What ends a row that hangs. Those that it started are ended by the guard of main.cpp.
void watch(const std::stop_token& over, const Row& row) {
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    if (ended.wait_for(lock, over, slowdown * row.limit, [&] { return over.stop_requested(); })) return;
    if (over.stop_requested()) return;
    std::cout << "seen: took longer than its " << (slowdown * row.limit).count() << " s" << std::endl;
    _exit(1);
}

// What the last line of progress says when each tile was counted once.
std::string all_tiles(const Words& picture) {
    const auto samples = std::find(picture.begin(), picture.end(), "--samples");
    const auto size = std::find(picture.begin(), picture.end(), "--size");
    const int side = std::stoi(size[1]) / 16;
    const int tiles = side * side * std::max(1, std::stoi(samples[1]) / 16);
    return fmt::format("\"done\":{0},\"total\":{0},", tiles);
}

std::string report_in(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().filename().string().ends_with("run.json")) return bytes_of(entry.path());
    return {};
}

}  // namespace

Words join(Words one, const Words& more) {
    one.insert(one.end(), more.begin(), more.end());
    return one;
}

Words under(const std::string& setting, const Words& words) {
    return join({"/bin/bash", "-c", setting + " && exec \"$@\"", "bash"}, words);
}

std::size_t times(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

double memory_of(int process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/statm");
    double all = 0, pages = 0;
    in >> all >> pages;
    return pages * static_cast<double>(sysconf(_SC_PAGE_SIZE)) / 1e6;
}

std::size_t descriptors_of(int process) {
    std::error_code gone;
    const std::filesystem::directory_iterator first("/proc/" + std::to_string(process) + "/fd", gone);
    return gone ? 0 : static_cast<std::size_t>(std::distance(begin(first), end(first)));
}

std::string whole(const std::string& endpoint) { return "\"" + endpoint + "\" { places = 1 }"; }

Words daemon_words(const std::string& cache, const Words& more) {
    return join({program("lightnetd"), "--listen", "tcp://127.0.0.1:*", "--places", "1", "--cache", cache}, more);
}

OddDaemon::OddDaemon(const Words& words) : process(std::make_unique<Process>(words)) {
    const std::string before = "listening on ";
    if (!process->wait_for(before) || !process->wait_for("\n")) return;
    const auto at = process->output().find(before) + before.size();
    endpoint = process->output().substr(at, process->output().find('\n', at) - at);
}

void Faults::SetUp() {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.test == name; });
    ASSERT_NE(found, rows.end()) << name << " stands in no row of the table";
    row_ = found;
    watch_ = std::jthread([this](const std::stop_token& over) { watch(over, *row_); });
}

void Faults::TearDown() { watch_ = {}; }

std::string Faults::reference(const Words& picture) {
    const auto name = fmt::format("{:016x}.exr", std::hash<std::string>{}(joined(picture)));
    if (!shelf().empty() && std::filesystem::exists(shelf() / name)) return bytes_of(shelf() / name);
    const Folder peace;
    const auto run =
        launch(graph_file("cornell.lua"), peace, join(picture, {"--threads", "1"}), slowdown * seconds(120));
    EXPECT_EQ(run.code, 0) << run.said;
    if (!shelf().empty()) std::ofstream(shelf() / name, std::ios::binary) << run.picture;
    return run.picture;
}

std::unique_ptr<Process> Faults::start(const Words& picture, const Words& more) {
    return std::make_unique<Process>(launch_words(graph_file("cornell.lua"), out, join(picture, more)));
}

std::string Faults::hosts_file(const std::vector<std::string>& places) {
    std::string text;
    for (const auto& place : places) text += "place " + place + "\n";
    return folder.write("hosts.lua", text);
}

std::unique_ptr<Process> Faults::start_in_the_middle(const Words& picture, const Words& more) {
    auto run = start(picture, more);
    EXPECT_TRUE(run->wait_for("\"event\":\"progress\"", slowdown * seconds(60))) << run->output();
    return run;
}

std::string Faults::expect_same(Process& run, const Words& picture) {
    const int code = run.wait(slowdown * seconds(120));
    EXPECT_EQ(code, 0) << run.output();
    if (code != 0) return {};
    EXPECT_TRUE(bytes_of(out) == reference(picture)) << "the bytes differ\n" << run.output();
    const auto last = run.output().rfind("\"event\":\"finish\"");
    EXPECT_NE(run.output().find(all_tiles(picture), std::min(last, run.output().size())), std::string::npos)
        << "not every tile was counted once\n"
        << run.output();
    return report_in(folder.path());
}

bool Faults::pause(Process& run, milliseconds length) {
    run.wait_for("never said", length);
    return run.wait(milliseconds(1)) < 0;
}

void Faults::done(const std::string& what) const { std::cout << "done: " << what << std::endl; }

void Faults::seen(const std::string& what) const { std::cout << "seen: " << what << std::endl; }

void Faults::figure(const std::string& name, double value, const std::string& unit, double goal, bool at_least) const {
    const bool met = at_least ? value >= goal : value <= goal;
    std::cout << fmt::format("faults.{}.{} {:.2f} {}{:g} ({}) {}\n", row_->name, name, value,
                             at_least ? ">=" : "<=", goal, unit, met ? "ok" : "short")
              << std::flush;
}

int connect_to(const std::string& endpoint) {
    const int file = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(endpoint.substr(endpoint.rfind(':') + 1))));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (file >= 0) (void)::connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    return file;
}

}  // namespace lightnet::test
