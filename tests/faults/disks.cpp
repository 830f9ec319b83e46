// Disks that are full, gone or sick: of the launcher, and of a daemon.
#include <fmt/format.h>
#include <sys/stat.h>

#include <csignal>

#include "core/base/hash.hpp"
#include "tests/faults/faults.hpp"
#include "tests/faults/small_disk.hpp"

namespace lightnet::test {
namespace {

const Words small{"--size", "64x64", "--samples", "1", "--tile", "16", "--progress", "json"};

// A run whose picture lies on the disk, and that may flee to `shelter`.
std::unique_ptr<Process> run_to(const std::filesystem::path& picture, const std::string& shelter, const Words& more) {
    std::filesystem::create_directories(shelter);
    return std::make_unique<Process>(under(
        "export TMPDIR=" + shelter, launch_words(graph_file("cornell.lua"), picture, join(more, {"--threads", "2"}))));
}

// The picture that stands somewhere in a folder, or below it.
std::string picture_below(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".exr") return bytes_of(entry.path());
    return {};
}

// What nobody asked for: parts of files, say.
std::string strange_file_in(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const auto name = entry.path().filename().string();
        const bool known = name == "x.exr" || name == "x.png" || name == "filler" || name.ends_with("run.json") ||
                           name.ends_with(".checkpoint") || name.ends_with(".lock");
        if (!known) return name;
    }
    return {};
}

TEST_F(Faults, OfADiskThatIsFullLeaveOldFilesWhole) {
    if (const auto why = SmallDisk::obstacle(); !why.empty()) NOT_RUN(why);
    const auto wanted = reference(small);
    const Folder other;
    const auto old = launch(graph_file("cornell.lua"), other, join(small, {"--threads", "1", "--seed", "9"})).picture;
    int whole_new = 0, fled = 0, points = 0;
    const SmallDisk disk(folder / "disk", 1024);
    const auto file = disk.path() / "x.exr";
    for (std::size_t room = 0; room <= 160 && !HasFailure(); room += 8, ++points) {
        for (const auto& entry : std::filesystem::directory_iterator(disk.path())) std::filesystem::remove(entry);
        std::ofstream(file, std::ios::binary) << old;
        disk.leave(room);
        const auto shelter = folder.file("shelter-" + std::to_string(room));
        const auto run = run_to(file, shelter, join(small, {"--wait", "0"}));
        const int code = run->wait(slowdown * seconds(30));
        SCOPED_TRACE(fmt::format("with {} kB left: {}", room, run->output()));
        const auto now = bytes_of(file);
        EXPECT_TRUE(code == 0 || code == 1) << code;
        EXPECT_TRUE(now == wanted || (code == 1 && now == old)) << "neither the old picture nor the new one";
        EXPECT_EQ(strange_file_in(disk.path()), "");
        whole_new += now == wanted;
        if (now == wanted) continue;
        const bool safe = picture_below(shelter) == wanted;
        EXPECT_TRUE(safe) << "the picture is lost";
        EXPECT_NE(run->output().find(shelter), std::string::npos) << "it should say where the picture is";
        fled += safe;
    }
    done(fmt::format("a picture written with 0 to 160 kB left, {} points", points));
    seen(fmt::format("{} times the new picture in its place, {} times in $TMPDIR and the old one left", whole_new,
                     fled));
    EXPECT_GT(whole_new, 0);

    // Full when the run ends, and free again while it waits.
    disk.leave(0);
    auto run = run_to(file, folder / "shelter", join(small, {"--wait", "60"}));
    EXPECT_TRUE(pause(*run, milliseconds(3000))) << "it should wait for room\n" << run->output();
    disk.clear();
    EXPECT_EQ(run->wait(slowdown * seconds(60)), 0) << run->output();
    EXPECT_TRUE(bytes_of(file) == wanted);

    // Gone when the run ends.
    const auto gone = folder / "gone";
    std::filesystem::create_directories(gone);
    run = run_to(gone / "x.exr", folder / "shelter-gone", join(usual, {"--wait", "1"}));
    EXPECT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    std::filesystem::remove_all(gone);
    EXPECT_EQ(run->wait(slowdown * seconds(60)), 1) << run->output();
    EXPECT_TRUE(picture_below(folder / "shelter-gone") == reference(usual)) << "the picture is lost\n" << run->output();

    // The files of this user may not become so large.
    std::ofstream(file, std::ios::binary) << old;
    Process limited(
        under("ulimit -f 40 && export TMPDIR=" + folder.file("shelter"),
              launch_words(graph_file("cornell.lua"), file, join(small, {"--threads", "2", "--wait", "0"}))));
    EXPECT_EQ(limited.wait(slowdown * seconds(30)), 1) << limited.output();
    EXPECT_TRUE(bytes_of(file) == old);
}

// A pipe where the scene's file is to lie: who opens it waits for ever.
void put_a_pipe(const std::filesystem::path& cache) {
    const auto scene = bytes_of(graph_file("cornell_box.pbrt"));
    const auto hash = content_hash(std::as_bytes(std::span(scene)));
    EXPECT_EQ(::mkfifo((cache / to_hex(hash)).c_str(), 0600), 0);
}

TEST_F(Faults, OfOneHostsDiskTakeOutThatHostOnly) {
    if (const auto why = SmallDisk::obstacle(); !why.empty()) NOT_RUN(why);
    reference(usual);
    const Daemon healthy(folder);
    const SmallDisk full(folder / "full", 300), read_only(folder / "read-only", 300), piped(folder / "piped", 300);
    std::vector<std::string> slow_to_leave;
    int runs = 0;
    for (const SmallDisk* disk : {&full, &read_only, &piped}) {
        const auto cache = disk->path() / "cache";
        const OddDaemon sick(daemon_words(cache, {"--drain", "2"}));
        if (disk == &full) disk->leave(0);
        if (disk == &read_only) disk->protect();
        if (disk == &piped) put_a_pipe(cache);
        const auto name = disk->path().filename().string();
        SCOPED_TRACE(name + "\n" + sick.process->output());
        ASSERT_FALSE(sick.endpoint.empty());
        const auto run = start(usual, {"--hosts", hosts_file({whole(sick.endpoint), whole(healthy.endpoint)})});
        EXPECT_GE(run->wait(slowdown * seconds(40)), 0) << "it waits for a host that is sick\n" << run->output();
        expect_same(*run, usual);
        sick.process->signal(SIGTERM);
        if (sick.process->wait(slowdown * seconds(8)) != 0) slow_to_leave.push_back(name);
        ++runs;
    }
    done(fmt::format("{} runs on a good host and one whose cache is full, read-only, a pipe", runs));
    seen(fmt::format("{} of the sick ones did not end when told to", slow_to_leave.size()));
    EXPECT_TRUE(slow_to_leave.empty()) << slow_to_leave.front();
}

}  // namespace
}  // namespace lightnet::test
