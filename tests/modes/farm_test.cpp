// What farms do to programs: names of files as old disks have them, no home, few descriptors, few threads, cores that
// are given to others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/modes/daemons.hpp"
#include "tests/support/schema.hpp"

namespace lightnet::test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Tree = nlohmann::json;

const std::string scene_text =
    "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
    "LightSource \"infinite\"\nShape \"sphere\"\n";
const std::string graph_text =
    "scene = Scene { 'box.pbrt' }\ndirect = DirectLighting { samples = 1 }\n"
    "image = RayTracer { direct, scene = scene, samples = 1, film = { 8, 8, file = 'x.exr' } }\n";

/// A shell's command line; what it says, and how it ends.
struct Said {
    int code = -1;
    std::string text;
};
Said shell(const std::string& command) {
    Process process({"/bin/sh", "-c", command});
    Said said{process.wait(), ""};
    said.text = process.output();
    return said;
}

class Farm : public ::testing::Test {
protected:
    std::string launcher() const { return program("lightnet"); }
    std::string run(const std::string& graph, const std::string& more) const {
        return launcher() + " run '" + graph + "' --progress none --forget -o " + folder.file("o.exr") + " " + more;
    }

    Folder folder;
};

TEST_F(Farm, BytesOfFileNamesAreBytes) {
    const std::string name = "sc\xe4ne";
    folder.write(name + "/box.pbrt", scene_text);
    const auto graph = folder.write(name + "/box.lua", graph_text);
    const auto reference = shell(run(graph, "--threads 1"));
    ASSERT_EQ(reference.code, 0) << reference.text;
    const auto picture = bytes_of(folder / "o.exr");
    const auto report = Tree::parse(bytes_of(folder / "o.run.json"));
    EXPECT_THAT(report["graph"]["file"].get<std::string>(), HasSubstr("sc\\xe4ne"));
    for (const char* more : {"--threads 2", "--local-workers 1"}) {
        const auto again = shell(run(graph, more));
        EXPECT_EQ(again.code, 0) << more << again.text;
        EXPECT_TRUE(bytes_of(folder / "o.exr") == picture) << more;
    }
    const auto rendered = shell(launcher() + " render '" + folder.file(name + "/box.pbrt") +
                                "' --samples 1 --progress none --forget -o " + folder.file("r.exr"));
    EXPECT_EQ(rendered.code, 0) << rendered.text;
}

TEST_F(Farm, ALatinGraphFindsItsLatinScene) {
    folder.write("b\xfc.pbrt", scene_text);
    auto text = graph_text;
    text.replace(text.find("box"), 3, "b\xfc");
    const auto said = shell(run(folder.write("g.lua", text), "--threads 1"));
    EXPECT_EQ(said.code, 0) << said.text;
    const auto missing = shell(run(folder.write("h\xfc.lua", "scene = Scene { 'none.pbrt' }\n" + text), "--threads 1"));
    EXPECT_EQ(missing.code, 2);
    EXPECT_THAT(missing.text, HasSubstr("h\\xfc.lua:1: ")) << "in its own name, line by line";
}

TEST_F(Farm, NoHomeIsNoHindrance) {
    folder.write("box.pbrt", scene_text);
    const auto graph = folder.write("box.lua", graph_text);
    const std::string homeless =
        "env -u XDG_CACHE_HOME -u XDG_CONFIG_HOME HOME=/dev/null/none TMPDIR=" + folder.path().string() + " ";
    const auto files = [&] {
        return std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator());
    };
    const auto given = shell(homeless + run(graph, "--local-workers 1 --cache " + folder.file("cache")));
    EXPECT_EQ(given.code, 0) << given.text;
    EXPECT_THAT(given.text, Not(HasSubstr("--cache"))) << "there is nothing to say";
    const auto before = files();
    for (const char* more : {"", "--cache none"}) {
        const auto plain =
            shell(homeless + launcher() + " run " + graph + " --local-workers 1 --progress plain --forget -o " +
                  folder.file("o.exr") + " " + more);
        EXPECT_EQ(plain.code, 0) << plain.text;
        EXPECT_THAT(plain.text, HasSubstr("--cache FOLDER chooses")) << more;
        EXPECT_EQ(files(), before) << "it takes away what it made";
    }
    Process daemon({"/bin/sh", "-c", "exec " + homeless + program("lightnetd")});
    EXPECT_TRUE(daemon.wait_for("listening on ")) << daemon.output();
    EXPECT_THAT(daemon.output(), HasSubstr("--cache FOLDER chooses"));
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0);
    EXPECT_EQ(files(), before);
}

TEST_F(Farm, FewDescriptorsAreSaid) {
    folder.write("box.pbrt", scene_text);
    const auto graph = folder.write("box.lua", graph_text);
    for (const char* most : {"4", "5", "6", "7", "8", "9", "10", "11", "12", "16", "24"}) {
        const auto said = shell("ulimit -n " + std::string(most) + "; exec " + run(graph, "--threads 2"));
        // The fewest may not do for the loader, before there is a program that could say so.
        if (said.code == 127 && said.text.find("while loading shared libraries") != std::string::npos) continue;
        EXPECT_TRUE(said.code == 0 || said.code == 1 || said.code == 2) << most << ": " << said.code << said.text;
        EXPECT_THAT(said.text, Not(HasSubstr("signal"))) << most;
        EXPECT_THAT(said.text, Not(HasSubstr("without an answer"))) << most;
        if (said.code != 0 && std::string(most) >= "10" && std::string(most).size() == 2) {
            EXPECT_THAT(said.text, HasSubstr("descriptors")) << most;
        }
    }
}

// Root is above limits of threads, so the memory for their stacks is what lacks: of 12 GB there are enough for all, for
// some, and for none. (A sanitizer wants more itself.)
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(Farm, FewThreadsEndInWords) {
    folder.write("box.pbrt", scene_text);
    const auto graph = folder.write("box.lua", graph_text);
    constexpr int enough = 64, hardly_any = 4096;  // MiB of stack
    for (const int stack : {enough, 1024, 2048, 3072, hardly_any, 2 * hardly_any}) {
        const auto few = "ulimit -s " + std::to_string(stack * 1024) + "; ulimit -v 12000000; exec ";
        for (const auto& command :
             {run(graph, "--threads 4"), launcher() + " hosts tcp://127.0.0.1:1", launcher() + " doctor",
              "timeout -s TERM 2 " + program("lightnetd") + " --places 2 --cache " + folder.file("c")}) {
            const auto said = shell(few + command);
            EXPECT_LT(said.code, 128) << stack << " MiB of stack: " << command << '\n' << said.text;
            EXPECT_THAT(said.text, Not(HasSubstr("src/thread.cpp"))) << command;
            if (stack == enough) {
                EXPECT_THAT(said.text, Not(HasSubstr("threads more"))) << command;
            } else if (stack >= hardly_any) {
                EXPECT_EQ(said.code, 1) << command << '\n' << said.text;
                EXPECT_THAT(said.text, HasSubstr("threads more, and the system gives ")) << command;
            }
        }
    }
}
#endif

TEST_F(Farm, CoresAreThoseThatOneMayUse) {
    folder.write("box.pbrt", scene_text);
    const auto graph = folder.write("box.lua", graph_text);
    cpu_set_t mine{};
    ASSERT_EQ(sched_getaffinity(0, sizeof mine, &mine), 0);
    int first = 0;
    while (!CPU_ISSET(first, &mine)) ++first;
    const auto bound = "taskset -c " + std::to_string(first) + " ";
    for (const auto& limit : {bound, std::string("env OMP_NUM_THREADS=1 ")}) {
        const auto said =
            shell(limit + launcher() + " run " + graph + " --forget --progress plain -o " + folder.file("o.exr"));
        EXPECT_EQ(said.code, 0) << said.text;
        EXPECT_EQ(Tree::parse(bytes_of(folder / "o.run.json"))["mode"], "serial") << limit;
        Process daemon({"/bin/sh", "-c", "exec " + limit + program("lightnetd") + " --cache " + folder.file("c")});
        ASSERT_TRUE(daemon.wait_for("\n")) << daemon.output();
        const auto at = daemon.output().find("tcp://");
        const auto endpoint = daemon.output().substr(at, daemon.output().find('\n', at) - at);
        EXPECT_THAT(shell(launcher() + " hosts " + endpoint).text, HasSubstr(" 1 place ")) << limit;
        daemon.signal(SIGTERM);
        daemon.wait();
    }
}

TEST_F(Farm, MemoryIsTold) {
    folder.write("box.pbrt", scene_text);
    const auto graph = folder.write("box.lua", graph_text);
    const auto said = shell(run(graph, "--local-workers 1"));
    ASSERT_EQ(said.code, 0) << said.text;
    const auto report = Tree::parse(bytes_of(folder / "o.run.json"));
    EXPECT_GT(report["peak_memory"].get<double>(), 1e6);
    EXPECT_GT(report["hosts"][0]["peak_memory"].get<double>(), 1e6);
}

TEST_F(Farm, HostsAreToldToPrograms) {
    const Daemon daemon(folder);
    const auto said = shell(launcher() + " hosts --json " + daemon.endpoint + " tcp://127.0.0.1:1 2>/dev/null");
    EXPECT_EQ(said.code, 3);
    const auto json = Tree::parse(said.text);
    EXPECT_EQ(json["format"], "lightnet hosts 1");
    ASSERT_EQ(json["hosts"].size(), 2u);
    EXPECT_EQ(json["hosts"][0]["asked"], daemon.endpoint);
    EXPECT_EQ(json["hosts"][0]["same_build"], true);
    EXPECT_EQ(json["hosts"][0]["there"], true);
    EXPECT_GT(json["hosts"][0]["resident_memory"].get<double>(), 1e6);
    EXPECT_EQ(json["hosts"][1]["there"], false);
    if (!schemas_can_be_checked()) GTEST_SKIP() << "Python's package jsonschema is not here";
    EXPECT_EQ(complaints_of_schema("hosts", folder.write("hosts.json", said.text)), "");
}

TEST_F(Farm, EachLineOfAJsonLogIsJson) {
    const auto lines_of = [](const std::string& text) {
        std::vector<std::string> lines;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) lines.push_back(line);
        return lines;
    };
    const Daemon daemon(folder, 1, "tcp://127.0.0.1:*", {"--log-format", "json", "--metrics", "127.0.0.1:0"});
    EXPECT_THAT(daemon.endpoint, StartsWith("tcp://127.0.0.1:"));
    EXPECT_TRUE(daemon.process->wait_for("metrics at"));
    daemon.process->signal(SIGTERM);
    EXPECT_EQ(daemon.process->wait(), 0);
    auto all = lines_of(daemon.process->output());
    EXPECT_GE(all.size(), 2u);
    const std::string json = " --log-format=json ";
    const std::vector<std::string> mistakes{"--listen " + daemon.endpoint + "x" + json,
                                            json + "--places many",
                                            json + "--nonsense",
                                            "--log-format json --listen tcp://203.0.113.1:7777 --insecure",
                                            json + "--cache /dev/null/none",
                                            json + "--plugin /none.so",
                                            json + "--metrics 203.0.113.1:1 --insecure --cache " + folder.file("d")};
    for (const auto& mistake : mistakes) {
        const auto said = shell("timeout 10 " + program("lightnetd") + " " + mistake);
        EXPECT_NE(said.code, 0) << mistake;
        EXPECT_NE(said.text, "") << mistake;
        const auto more = lines_of(said.text);
        all.insert(all.end(), more.begin(), more.end());
    }
    std::string whole;
    for (const auto& line : all) {
        EXPECT_TRUE(Tree::accept(line)) << line;
        whole += line + "\n";
    }
    if (!schemas_can_be_checked()) GTEST_SKIP() << "Python's package jsonschema is not here";
    EXPECT_EQ(complaints_of_schema("log", folder.write("log", whole), true), "");
}

}  // namespace
}  // namespace lightnet::test
