// Nodes that fail on one host, or on all.
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.hpp"
#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::faulty_host_test {
namespace {

using namespace std::chrono_literals;
using namespace test;
using ::testing::HasSubstr;

enum class Trouble { none, preparing, answering };

// Was anything answered where nothing is wrong? Before that, nobody may be there yet who could answer instead.
std::atomic<bool> others_answer{true};

void await_others() {
    const auto end = std::chrono::steady_clock::now() + test::slowdown * 20s;
    while (!others_answer && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(1ms);
}

std::atomic<bool> has_failed{false};

// Passes light on, where it is not in trouble.
class Fragile final : public LightOp {
public:
    Fragile(const NodeContext& here, Trouble trouble) : inputs_(here.inputs()), trouble_(trouble) {}
    void prepare(Services&) override {
        if (trouble_ == Trouble::preparing) fail();
    }
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        if (trouble_ == Trouble::answering) await_others();
        if (trouble_ == Trouble::answering) fail();
        for (const Part& part : ask_all(inputs_, questions)) add(part, answers);
        others_answer = true;
    }

private:
    [[noreturn]] static void fail() {
        has_failed = true;
        throw std::bad_alloc();
    }

    Inputs inputs_;
    Trouble trouble_;
};

Registry with_fragile(Trouble trouble) {
    auto kinds = standard_nodes();
    Kind fragile{.name = "Fragile", .help = "passes light on", .inputs = {1, 1}};
    fragile.run.prepares = true;
    fragile.make_light = [trouble](const NodeContext& here) { return std::make_unique<Fragile>(here, trouble); };
    kinds.push_back(std::move(fragile));
    return Registry(std::move(kinds));
}

class FaultyHost : public ::testing::TestWithParam<Trouble> {
protected:
    static std::vector<Node> nodes() {
        const auto ref = [](const char* name) { return Value{NodeRef{name}}; };
        return {node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("direct", "DirectLighting", {}),
                node("fragile", "Fragile", {ref("direct")}), node("image", "RayTracer", {ref("fragile")}, seen())};
    }
    // Each host holds everything, or (`spread_out`) operators are spread round about.
    std::vector<Pixels> render_on(const std::vector<std::string>& endpoints, bool spread_out,
                                  std::chrono::milliseconds patience = test::slowdown * 20s) {
        const std::atomic<bool> never{false};
        auto options = cluster_of(learning, endpoints);
        if (!spread_out)
            options.plan = [this](const std::vector<HostOffer>& offers) {
                return plan(learning.network->graph, learning.registry, {}, offers);
            };
        options.say = [this](const std::string& text) { said += text + "\n"; };
        Cluster cluster(std::move(options));
        cluster.gather(patience, never);
        auto pixels = learning.networked(cluster);
        cluster.finish();
        return pixels;
    }

    Learning learning{with_fragile(Trouble::none), nodes()};
    Registry sick = with_fragile(GetParam()), healthy = with_fragile(Trouble::none);
    Folder folder;
    std::string said;
};

TEST_P(FaultyHost, IsTakenOutAndTheOthersGoOn) {
    const auto expected = learning.serial();
    for (const bool spread_out : {false, true}) {
        HostThread one(sick, 1, folder.file("one")), two(healthy, 1, folder.file("two")),
            three(healthy, 1, folder.file("three"));
        said.clear();
        // The others may be done with so small a picture before the sick one is prepared and asked for anything.
        for (int run = 0; run < 10 && said.find("is taken out") == std::string::npos; ++run) {
            others_answer = false;
            EXPECT_EQ(render_on({one.endpoint(), two.endpoint(), three.endpoint()}, spread_out), expected);
        }
        EXPECT_THAT(said, HasSubstr(one.endpoint() + " is taken out: ")) << (spread_out ? "spread out" : "whole");
        EXPECT_THAT(said, HasSubstr("there is not enough memory"));
    }
}

TEST_P(FaultyHost, EndsTheRunWhenASecondFailsAtTheSame) {
    others_answer = true;
    HostThread one(sick, 1, folder.file("one")), two(sick, 1, folder.file("two")), three(sick, 1, folder.file("three"));
    try {
        render_on({one.endpoint(), two.endpoint(), three.endpoint()}, false);
        FAIL() << "nobody noticed";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("there is not enough memory"));
    }
}

TEST_P(FaultyHost, EndsTheRunWhenItIsTheOnlyOne) {
    others_answer = true;
    HostThread one(sick, 2, folder.file("one"));
    EXPECT_THROW(render_on({one.endpoint()}, false), Error);
}

// A place where nobody is yet.
std::string free_endpoint(const Registry& kinds, const std::string& cache) {
    return HostThread(kinds, 1, cache).endpoint();
}

TEST_P(FaultyHost, DoesNotEndTheRunWhileAnotherIsComing) {
    const auto expected = learning.serial();
    others_answer = true, has_failed = false;
    HostThread one(sick, 1, folder.file("one"));
    Host::Options later;
    later.listen = free_endpoint(healthy, folder.file("two")), later.cache = folder.file("two");
    std::unique_ptr<HostThread> two;
    std::jthread comes([&] {
        while (!has_failed) std::this_thread::sleep_for(1ms);
        two = std::make_unique<HostThread>(healthy, later);
    });
    EXPECT_EQ(render_on({one.endpoint(), later.listen}, false, test::slowdown * 3s), expected);
    EXPECT_THAT(said, HasSubstr(one.endpoint() + " is taken out: "));
}

TEST_P(FaultyHost, EndsTheRunWhenTheOtherDoesNotCome) {
    others_answer = true;
    HostThread one(sick, 1, folder.file("one"));
    const auto nobody = free_endpoint(healthy, folder.file("two"));
    try {
        render_on({one.endpoint(), nobody}, false, 500ms);
        FAIL() << "nobody noticed";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("there is not enough memory"));
    }
}

INSTANTIATE_TEST_SUITE_P(Trouble, FaultyHost, ::testing::Values(Trouble::preparing, Trouble::answering),
                         [](const auto& trouble) {
                             return trouble.param == Trouble::preparing ? "Preparing" : "Answering";
                         });

}  // namespace
}  // namespace lightnet::faulty_host_test
