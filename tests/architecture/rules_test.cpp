// Each rule of the house bites: a planted breach is found, and what is allowed is not.
#include "tests/architecture/rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightnet::house {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string including(const std::string& name) { return "#include \"" + name + "\"\n"; }

TEST(Rooms, OfCoreSeeNobodyElse) {
    EXPECT_THAT(stray_includes({"core/network/graph/check.cpp", "\n" + including("lua/load_graph.hpp")}),
                ElementsAre("core/network/graph/check.cpp:2: core/network does not see lua"));
    EXPECT_THAT(stray_includes(
                    {"core/network/graph/check.cpp", including("core/network/light/port.hpp") + "#include <vector>\n"}),
                IsEmpty());
}

TEST(Rooms, OfCoreSeeOnlyWhatLiesBelow) {
    const auto complaints = [](const std::string& room, const std::string& seen) {
        return stray_includes({room + "/x.cpp", including(seen + "/y.hpp")});
    };
    const std::vector<std::string> upwards{"core/base", "core/scene", "core/network", "core/estimate"};
    for (std::size_t low = 0; low < upwards.size(); ++low)
        for (std::size_t high = low + 1; high < upwards.size(); ++high)
            EXPECT_THAT(complaints(upwards[low], upwards[high]), SizeIs(1)) << upwards[low] << " " << upwards[high];
    EXPECT_THAT(complaints("core/network", "core/scene"), SizeIs(1));
    EXPECT_THAT(complaints("core/readers", "core/run"), SizeIs(1));
    EXPECT_THAT(complaints("core/film", "core/scene"), SizeIs(1));
    EXPECT_THAT(complaints("nodes", "core/run"), SizeIs(1));
    EXPECT_THAT(complaints("lua", "core/readers"), SizeIs(1));
    EXPECT_THAT(complaints("core/estimate", "core/network"), IsEmpty());
    EXPECT_THAT(complaints("core/run", "core/readers/pbrt"), IsEmpty());
}

TEST(Rooms, NodesTransportAndLuaNeverSeeEachOther) {
    for (const std::string from : {"nodes", "transport/wire", "transport/launcher", "transport/daemon", "lua"})
        for (const std::string to : {"nodes", "transport/wire", "lua", "tools", "tests"})
            if (from.substr(0, 4) != to.substr(0, 4)) {
                EXPECT_THAT(stray_includes({from + "/x.cpp", "#include \"" + to + "/y.hpp\""}), SizeIs(1));
            }
}

TEST(Rooms, OfTransportSeeOnlyWhatLiesBelow) {
    const auto complaints = [](const std::string& room, const std::string& seen) {
        return stray_includes({"transport/" + room + "/x.cpp", including("transport/" + seen + "/y.hpp")});
    };
    EXPECT_THAT(complaints("launcher", "daemon"), SizeIs(1)) << "the two sides never see each other";
    EXPECT_THAT(complaints("daemon", "launcher"), SizeIs(1));
    for (const std::string low : {"wire", "places", "store", "start"})
        for (const std::string high : {"zmq", "launcher", "daemon"})
            EXPECT_THAT(complaints(low, high), SizeIs(1)) << low << " " << high;
    EXPECT_THAT(complaints("wire", "places"), SizeIs(1)) << "wire sees only core";
    EXPECT_THAT(complaints("places", "wire"), SizeIs(1)) << "any transport will do for places";
    EXPECT_THAT(complaints("zmq", "launcher"), SizeIs(1));
    EXPECT_THAT(complaints("launcher", "store"), SizeIs(1));
    EXPECT_THAT(complaints("launcher", "zmq"), IsEmpty());
    EXPECT_THAT(complaints("daemon", "store"), IsEmpty());
    EXPECT_THAT(complaints("zmq", "wire"), IsEmpty());
}

TEST(Rooms, ToolsSeeAll) {
    EXPECT_THAT(stray_includes({"tools/lightnet.cpp",
                                "#include \"core/base/error.hpp\"\n#include \"nodes/standard.hpp\"\n"
                                "#include \"transport/daemon/host.hpp\"\n#include \"lua/load.hpp\"\n"}),
                IsEmpty());
}

TEST(Rooms, KeepIncludesFromTheRoot) {
    EXPECT_THAT(stray_includes({"core/film/film.cpp", "#include \"film.hpp\""}), SizeIs(1));
    EXPECT_THAT(stray_includes({"nodes/x.cpp", "#  include \"../transport/packet.hpp\""}), SizeIs(1));
    EXPECT_THAT(stray_includes({"nodes/x.cpp", "#include \"nodes/combine.cpp\""}), SizeIs(1));
}

TEST(Homes, KeepEachLibraryInOneRoom) {
    EXPECT_THAT(stray_includes({"core/run/place/place.cpp", "#include <zmq.hpp>"}), SizeIs(1));
    EXPECT_THAT(stray_includes({"transport/zmq/socket.cpp", "#include <zmq.h>"}), IsEmpty());
    for (const std::string room : {"wire", "places", "store", "start", "launcher", "daemon"})
        EXPECT_THAT(stray_includes({"transport/" + room + "/x.cpp", "#include <zmq.hpp>"}), SizeIs(1)) << room;
    EXPECT_THAT(stray_includes({"transport/wire/body.cpp", "#include <msgpack.hpp>"}), IsEmpty());
    EXPECT_THAT(stray_includes({"transport/zmq/socket.cpp", "#include <msgpack.hpp>"}), SizeIs(1));
    EXPECT_THAT(stray_includes({"tools/lightnet.cpp", "#include <lua5.4/lua.h>"}), SizeIs(1));
    EXPECT_THAT(stray_includes({"lua/load_graph.cpp", "#include <lua.hpp>\n#include <lauxlib.h>"}), IsEmpty());
    EXPECT_THAT(stray_includes({"nodes/ray_tracer.cpp", "#include <embree3/rtcore.h>"}), SizeIs(1));
    EXPECT_THAT(stray_includes({"core/scene/geometry/geometry.cpp", "#include <embree3/rtcore.h>"}), IsEmpty());
    EXPECT_THAT(stray_includes({"core/scene/scene.cpp", "#include <ImfHeader.h>"}), SizeIs(1));
    EXPECT_THAT(stray_includes({"core/readers/images/image_jpeg.cpp", "#include <ImfHeader.h>\n#include <jpeglib.h>"}),
                IsEmpty());
    EXPECT_THAT(stray_includes({"nodes/combine.cpp", "#include <boost/context/fiber.hpp>"}), SizeIs(1));
}

TEST(Homes, KeepThirdPartiesOutOfHeaders) {
    EXPECT_THAT(stray_includes({"transport/zmq/socket.hpp", "#include <zmq.hpp>"}),
                ElementsAre("transport/zmq/socket.hpp:1: <zmq.hpp> in a header"));
    EXPECT_THAT(stray_includes({"core/base/error.hpp", "#include <fmt/format.h>"}), SizeIs(1));
    EXPECT_THAT(stray_includes({"core/base/error.hpp", "#include <string>"}), IsEmpty());
}

TEST(Nodes, HaveNothingOfDistributionInTheirCode) {
    for (const std::string word :
         {"std::thread t;", "std::jthread t;", "std::mutex m;", "std::shared_mutex m;", "std::atomic<int> n;",
          "std::atomic_int n;", "std::future<int> f;", "co_await x;", "std::async(f);", "thread_local int n;",
          "#include <condition_variable>", "zmq_send(s);", "msgpack::pack(b, q);", "#include <boost/context/fiber.hpp>",
          "here.whereabouts();", "us.hosts;"})
        EXPECT_THAT(words_of_distribution({"nodes/x.cpp", word}), SizeIs(1)) << word;
}

TEST(Nodes, MaySpeakOfAnythingInWords) {
    EXPECT_THAT(words_of_distribution({"nodes/x.cpp",
                                       "// no mutex is needed here\n/* a\n thread */ int a;\n"
                                       "throw Error(\"a promise\"); int threads_of_light;\n"}),
                IsEmpty());
}

TEST(Exceptions, OfAnyKindAreToldInWordsForPeople) {
    const std::string clause = "    } catch (const std::exception& e) {\n        say(e.what());\n    }\n";
    EXPECT_THAT(words_of_the_library({"tools/x.cpp", "    try {\n        work();\n" + clause}), SizeIs(1));
    EXPECT_THAT(words_of_the_library(
                    {"lua/x.cpp", "    try {\n    } catch (const std::bad_alloc&) {\n        none();\n" + clause}),
                IsEmpty());
    EXPECT_THAT(words_of_the_library({"tools/x.cpp",
                                      "    } catch (const std::exception& e) {\n        say(words_of(e));\n    }\n"
                                      "    } catch (const Error& e) {\n        say(e.what());\n    }\n"}),
                IsEmpty());
}

TEST(Files, AreReadByOneReader) {
    for (const char* code : {"#include <fstream>\n", "std::ifstream in(path);\n", "std::ofstream out(path);\n",
                             "FILE* file = fopen(path, \"r\");\n", "std::basic_ifstream<char> in;\n"})
        EXPECT_THAT(streams_of_files({"tools/x.cpp", code}), SizeIs(1)) << code;
    EXPECT_THAT(streams_of_files({"tools/x.cpp", "// an ifstream\nPlainFile file(\"fopen\", 1);\n"}), IsEmpty());
    EXPECT_THAT(streams_of_files({"core/base/own_process.cpp", "std::ifstream in(\"/proc/self/stat\");\n"}), IsEmpty());
}

TEST(CodeOnly, BlanksCommentsAndTextButKeepsLines) {
    EXPECT_EQ(code_only("a // b\nc /* d\ne */ f \"g\\\"h\" 'i' 1'000"), "a     \nc     \n     f \"    \" ' ' 1'000");
}

TEST(Headers, GuardThemselvesAndOpenNoNamespace) {
    EXPECT_THAT(bad_header({"core/x.hpp", "// a\nint x;\n"}), ElementsAre(HasSubstr("no #pragma once")));
    EXPECT_THAT(bad_header({"core/x.hpp", "#pragma once\nusing namespace std;\n"}),
                ElementsAre(HasSubstr("core/x.hpp:2")));
    EXPECT_THAT(bad_header({"core/x.hpp", "#pragma once\n"}), IsEmpty());
    EXPECT_THAT(bad_header({"core/x.cpp", "int x;\n"}), IsEmpty());
}

TEST(Types, HaveNamesOfTheirOwn) {
    const SourceFile one{"core/a.hpp", "namespace lightnet {\nstruct Look {\n};\n}\n"};
    const auto other = [](const std::string& text) { return SourceFile{"core/b.hpp", text}; };
    for (const std::string same : {"namespace lightnet {\nclass Look final : public Other {};\n}",
                                   "namespace lightnet { enum class Look : int { a }; }",
                                   "namespace lightnet { namespace { int x; } struct [[nodiscard]] Look {}; }",
                                   "namespace lightnet { template <class T> struct Look { }; }"})
        EXPECT_THAT(repeated_types({one, other(same)}),
                    ElementsAre(HasSubstr("lightnet::Look is defined in core/a.hpp")))
            << same;
    for (const std::string another :
         {"namespace lightnet { struct Look; class Looks {}; }", "namespace lightnet::gltf { struct Look {}; }",
          "namespace lightnet { namespace { struct Look {}; } }",
          "namespace lightnet { struct Eye { struct Look {}; }; }",
          "namespace lightnet { void f() { struct Look {}; } }", "namespace lightnet { // struct Look {\n}",
          "namespace lightnet { struct Eye::Look {}; template <class Look> struct Sight {}; enum class Look : int; }"})
        EXPECT_THAT(repeated_types({one, other(another)}), IsEmpty()) << another;
    EXPECT_THAT(repeated_types({other("namespace lightnet { struct Look {};")}),
                ElementsAre(HasSubstr("braces do not pair")));
}

TEST(Files, AreShort) {
    EXPECT_THAT(too_long({"core/x.cpp", "1\n2\n3\n"}, 3), IsEmpty());
    EXPECT_THAT(too_long({"core/x.cpp", "1\n2\n3\n4\n"}, 3), SizeIs(1));
}

TEST(Classes, HaveTheirMembersCounted) {
    const auto members = [](const std::string& code) {
        const auto sizes = class_sizes({"core/x.hpp", code});
        return sizes.empty() ? std::string("none") : sizes[0].name + " " + std::to_string(sizes[0].members);
    };
    EXPECT_EQ(members("class A final : public B { public: A(); int f() const { if (x) { return 1; } return 2; }\n"
                      "private: std::map<int, C> c_ = {}; double a = 0, b{}; };"),
              "A 4");
    EXPECT_EQ(members("struct A { A(const A&) = delete; ~A() = default; using T = int; friend class B; enum class E { "
                      "a };\n struct C { int x; } c; class D; template <class T> void f(T t) { t({}); } };"),
              "A 2");
    EXPECT_EQ(members("struct A { std::function<void()> f; // g();\n std::vector<int> v{1, 2}; "
                      "A(int x) : v{x} {} };"),
              "A 3");
    EXPECT_EQ(members("struct Out::A { bool operator()(int a) const { return a < 1; } int b; };"), "Out::A 2");
    EXPECT_EQ(members("class A; enum class B { c }; template <class T> void f(T);"), "none");
}

TEST(Classes, AreSmallButForDebts) {
    const SourceFile file{"core/x.hpp", "struct Big { int a; int b; int c; };\nstruct Small { int a; };\n"};
    EXPECT_THAT(too_large({file}, 3, {}), IsEmpty());
    EXPECT_THAT(too_large({file}, 2, {}), ElementsAre("core/x.hpp:1: Big has 3 members, and 2 are allowed"));
    EXPECT_THAT(too_large({file}, 2, {{"core/x.hpp Big", 3}}), IsEmpty());
    EXPECT_THAT(too_large({file}, 2, {{"core/x.hpp Big", 4}}), ElementsAre("the debt of core/x.hpp Big falls to 3"));
    EXPECT_THAT(too_large({file}, 3, {{"core/x.hpp Big", 4}}), ElementsAre(HasSubstr("its line goes")));
    EXPECT_THAT(too_large({file}, 3, {{"core/x.hpp Gone", 4}}), ElementsAre(HasSubstr("its line goes")));
}

TEST(Documents, ShowCodeAsItStandsInTheFile) {
    const std::vector<SourceFile> files{{"nodes/x.cpp", "// x\nint a;\nint b;\n"}};
    const std::string begin = "text\n<!-- cut from nodes/x.cpp -->\n```cpp\n", end = "```\nmore\n";
    EXPECT_THAT(stale_cuts({"A.md", begin + "int a;\nint b;\n" + end}, files), IsEmpty());
    EXPECT_THAT(stale_cuts({"A.md", begin + "int a;\nint c;\n" + end}, files),
                ElementsAre("A.md:2: nodes/x.cpp says something else"));
    EXPECT_THAT(stale_cuts({"A.md", "<!-- cut from nodes/x.cpp -->\nint a;\n"}, files), SizeIs(1));
    EXPECT_THAT(stale_cuts({"A.md", begin + "int a;\n" + end}, {}), SizeIs(1));
}

TEST(Folders, DoNotIncludeEachOther) {
    const SourceFile up{"core/graph/a.hpp", "#include \"core/light/b.hpp\""};
    const SourceFile down{"core/light/b.hpp", "#include \"core/math/c.hpp\""};
    const SourceFile back{"core/math/c.hpp", "#include \"core/graph/a.hpp\""};
    EXPECT_THAT(folder_circles({up, down}), IsEmpty());
    EXPECT_THAT(folder_circles({up, down, back}), SizeIs(3));
    EXPECT_THAT(glances({up, down}, "core/graph", "core/math"), IsEmpty());
    EXPECT_THAT(glances({up, down, back}, "core/graph", "core/math"), SizeIs(1));
    EXPECT_THAT(glances({up, down, back}, "core/math", "core/graph"), SizeIs(1));
}

TEST(Comments, HaveASubjectOfTheirOwn) {
    EXPECT_THAT(borrowed_subjects({"core/a.hpp", "/// Sums.\nint sum();\n/// The same of many.\nint sums();\n"}),
                ElementsAre("core/a.hpp:3: the subject of this comment stands in another one"));
    EXPECT_THAT(borrowed_subjects({"core/a.hpp", "/// Sums of many.\n/// The same ones as before.\nint sums();\n"}),
                IsEmpty());
}

TEST(Heads, SayWhatAFileHolds) {
    EXPECT_THAT(questions_for_heads({"core/a.hpp", "// How far it is.\n"}),
                ElementsAre("core/a.hpp:1: a noun says what the file holds, not a question"));
    EXPECT_THAT(questions_for_heads({"core/a.hpp", "// The distance.\n// How far it is.\n"}), IsEmpty());
    EXPECT_THAT(questions_for_heads({"core/a.hpp", "#pragma once\n// How far it is.\n"}), IsEmpty());
}

TEST(Rules, CountTheLinesThatWrapAClass) {
    const SourceFile file{
        "nodes/a.cpp",
        "template <>\nold::Eye made(World& world) {\n    return {world};\n}\n"
        "auto kinds() {\n    return wrap<old::Eye>(\"Eye (old::Eye)\",\n        {},\n        with(1));\n}\n"};
    EXPECT_THAT(long_wraps(file, 4), IsEmpty());
    EXPECT_THAT(long_wraps(file, 3), ElementsAre("nodes/a.cpp:6: 4 lines wrap old::Eye"));
}

}  // namespace
}  // namespace lightnet::house
