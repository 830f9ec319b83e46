// Documents and code agree: each rule bites, and the project keeps it.
#include "tests/architecture/documents.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/architecture/project_files.hpp"

namespace lightnet::house {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Pages some_notebook{
    {"docs/notebook/film.md", "# The film\n\n## blocks-of-16\n\nBecause. *Cited in*\n`core/film`.\n"},
    {"docs/notebook/base.md", "# Base\n\n## own-vectors\n\nBecause.\n"}};

TEST(Decisions, AreThereWhereCodeCitesThem) {
    EXPECT_THAT(unknown_decisions({"core/x.cpp", "int a;\n// DECISIONS: blocks-of-16\n"}, some_notebook), IsEmpty());
    EXPECT_THAT(unknown_decisions({"core/x.cpp", "int a;\n    // DECISIONS: blocks-of-17\n"}, some_notebook),
                ElementsAre("core/x.cpp:2: there is no decision 'blocks-of-17'"));
}

TEST(Decisions, AreCitedWhereTheySayThatTheyAre) {
    const SourceFile film{"core/film/x.cpp", "// DECISIONS: blocks-of-16\n"};
    EXPECT_THAT(uncited_decisions(some_notebook, {film}), IsEmpty());
    EXPECT_THAT(uncited_decisions(some_notebook, {}),
                ElementsAre("docs/notebook/film.md:3: 'blocks-of-16' is not cited in core/film"));
    EXPECT_THAT(uncited_decisions(some_notebook, {{"core/filmed/x.cpp", film.text}}), SizeIs(1)) << "another folder";
    EXPECT_THAT(uncited_decisions(some_notebook, {film, {"core/base/x.hpp", "// DECISIONS: own-vectors\n"}}),
                ElementsAre("docs/notebook/base.md:3: 'own-vectors' is cited in core/base/x.hpp"));
    EXPECT_THAT(uncited_decisions({{"a.md", "## a\n"}, {"b.md", "## a\n"}}, {}), SizeIs(1)) << "two of one key";
}

TEST(Decisions, StandInTheNotebookAtLength) {
    EXPECT_THAT(decisions_without_an_entry({"DECISIONS.md", "# Decisions\n### own-vectors\n"}, some_notebook),
                IsEmpty());
    EXPECT_THAT(decisions_without_an_entry({"DECISIONS.md", "# Decisions\n### own-films\n"}, some_notebook),
                ElementsAre("DECISIONS.md:2: the notebook has no 'own-films'"));
}

TEST(Documents, NameOnlyWhatTheCodeHas) {
    const std::vector<SourceFile> files{
        {"core/run/place.hpp",
         "// Door\nclass Place final {\n    void look();\n};\ntemplate <class T> struct Bundle {};\n"}};
    const auto complaints = [&](const std::string& text) { return unknown_names({"docs/x.md", text}, files); };
    EXPECT_THAT(complaints("`Place`, `Place::look`, `Bundle<Query>`, `look()`, `core/run/place.hpp`, `core/run/`, "
                           "`--wait`, `x.exr`, `image = 1`"),
                IsEmpty());
    for (const std::string wrong : {"`Door`", "`Place::open`", "`ask()`", "`core/run/door.hpp`", "`core/walk/`"})
        EXPECT_THAT(complaints("fine\n" + wrong), SizeIs(1)) << wrong;
}

TEST(Documents, TellFiguresThatTheCodeHas) {
    const SourceFile code{"core/x.hpp", "    int room = 1'024;  // questions\n"};
    const auto complaint = [&](const std::string& text) {
        return disagreement({"docs/x.md", "full (# questions)", "core/x.hpp", "int room = #;"}, {"docs/x.md", text},
                            code);
    };
    EXPECT_EQ(complaint("when it is full (1024\n   questions)."), "");
    EXPECT_EQ(complaint("full (512 questions)"), "docs/x.md: full (# questions): it says 512, core/x.hpp has 1024");
    EXPECT_EQ(complaint("empty"), "docs/x.md says no longer: full (# questions)");
    EXPECT_EQ(disagreement({"docs/x.md", "# s", "core/x.hpp", "float room = #;"}, {"docs/x.md", "3 s"}, code),
              "core/x.hpp says no longer: float room = #;");
    EXPECT_EQ(disagreement({"docs/x.md", "# ms", "core/x.hpp", "room = #;", 1e-3}, {"docs/x.md", "1.024 ms"}, code),
              "");
}

TEST(Documents, LinkToFilesThatAreThere) {
    const auto exists = [](const std::string& path) { return path == "docs/words.md"; };
    EXPECT_THAT(
        dead_links({"README.md", "[a](docs/words.md) [b](https://x.org/y) [c](#d) [e](docs/words.md#f)"}, exists),
        IsEmpty());
    EXPECT_THAT(dead_links({"docs/x.md", "[a](words.md)\n[b](word.md)"}, exists),
                ElementsAre("docs/x.md:2: there is no word.md"));
}

TEST(Documents, ListTheServicesThatThereAreAndThatNodesUse) {
    const SourceFile header{"s.hpp",
                            "class Services {\npublic:\n    virtual ~Services() = default;\n    template <class T>\n"
                            "    Mapped<T> map(int count) {\n        return more(count);\n    }\n"
                            "    virtual const Hut& hut() const = 0;\nprotected:\n    virtual int inner() = 0;\n};\n"
                            "class Other {\npublic:\n    int other();\n};\n"};
    const Offer offer = offer_of(header, "Services", "services");
    EXPECT_THAT(offer.functions, ElementsAre("map", "hut"));
    const SourceFile document{"x.md", "`services.map<T>(count)` does.\n`services.hat()` too\n"};
    EXPECT_THAT(unlisted_services(document, offer), ElementsAre("x.md says nothing of `services.hut()`"));
    EXPECT_THAT(idle_services(document, offer, {{"n.cpp", "x = services.map<int>(3);"}}),
                ElementsAre("x.md:2: there is no `services.hat()`"));
    EXPECT_THAT(
        idle_services({"x.md", "`services.map()`"}, offer, {{"n.cpp", "// services.map()\nservices.mapped();"}}),
        ElementsAre("x.md:1: no node uses `services.map()`"));
}

// Whoever wraps old code uses what a node uses.
TEST(Project, ListsTheServicesThatItsNodesUse) {
    const SourceFile document = read("CONTRIBUTING.md");
    const Offer services = offer_of(read("core/network/light/services.hpp"), "Services", "services");
    const Offer here = offer_of(read("core/network/light/node_context.hpp"), "NodeContext", "here");
    auto nodes = files_of("nodes");
    std::ranges::move(files_of("core/estimate"), std::back_inserter(nodes));
    nodes.push_back(read("core/network/light/wrap.cpp"));
    EXPECT_GE(services.functions.size(), 7u);
    EXPECT_THAT(unlisted_services(document, services), IsEmpty());
    EXPECT_THAT(idle_services(document, services, nodes), IsEmpty());
    EXPECT_THAT(idle_services(document, here, nodes), IsEmpty());
}

TEST(Project, CitesDecisionsThatAreThere) {
    Pages notebook;
    for (const auto& entry : std::filesystem::directory_iterator(root() / "docs/notebook"))
        notebook.push_back(read(entry.path().lexically_relative(root())));
    auto files = all_files();
    std::ranges::move(files_of("cmake"), std::back_inserter(files));
    Complaints all = uncited_decisions(notebook, files);
    for (const SourceFile& file : files)
        if (!file.path.starts_with("tests/"))
            std::ranges::move(unknown_decisions(file, notebook), std::back_inserter(all));
    EXPECT_THAT(all, IsEmpty());
    const SourceFile decisions = read("DECISIONS.md");
    EXPECT_THAT(decisions_without_an_entry(decisions, notebook), IsEmpty());
    EXPECT_LE(decisions.text.size(), 25'000u) << "what is longer belongs into the notebook";
}

TEST(Project, HasDocumentsThatNameWhatIsThere) {
    const auto files = all_files();
    for (const char* document : {"README.md", "docs/engine.md", "docs/words.md"})
        EXPECT_THAT(unknown_names(read(document), files), IsEmpty());
}

TEST(Project, HasDocumentsWhoseFiguresAreTheCodes) {
    const std::string engine = "docs/engine.md", tuning = "core/run/message/tuning.hpp";
    const std::vector<Figure> figures{
        {engine, "when it is full (# questions", tuning, "std::uint32_t bundle = #;"},
        {engine, "or # ms of work for the answerer", "core/run/place/full_bundle.hpp", "enough_work = #;", 1000},
        {engine, "has waited long enough (# ms", tuning, "std::uint32_t oldest_us = #;", 1e-3},
        {engine, "usually takes, up to # times as long", "core/run/place/company_wait.hpp", "least_, # * least_"},
        {engine, "(#, 8192 and 8 MiB)", tuning, "std::uint32_t credit = #;"},
        {engine, "(32, # and 8 MiB)", tuning, "credit_questions = #;"},
        {engine, "8192 and # MiB)", tuning, "credit_bytes = std::uint64_t{#} << 20;"},
        {engine, "by `HostLink`: no sign of life for # s", "transport/launcher/remote_host.cpp",
         "lease = std::chrono::milliseconds(#)", 1e-3},
        {engine, "or after # s without any", "transport/zmq/zmq_carrier.cpp",
         "shortest_patience = std::chrono::milliseconds(#)", 1e-3},
        {engine, "a block of # samples of all pixels is a pass", "core/film/tile.hpp", "samples_per_block = #"},
    };
    for (const Figure& figure : figures) EXPECT_EQ(disagreement(figure, read(figure.document), read(figure.file)), "");
}

TEST(Project, HasDocumentsWhoseLinksLead) {
    const auto exists = [](const std::string& path) { return std::filesystem::exists(root() / path); };
    std::vector<std::string> documents{"README.md", "CONTRIBUTING.md", "CHANGELOG.md"};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root() / "docs"))
        if (entry.path().extension() == ".md" && entry.path().parent_path().filename() != "site")
            documents.push_back(std::filesystem::relative(entry.path(), root()));
    for (const auto& document : documents) EXPECT_THAT(dead_links(read(document), exists), IsEmpty());
}

}  // namespace
}  // namespace lightnet::house
