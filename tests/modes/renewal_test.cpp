// Lines with keys are replaced while they are in use.
#include <gmock/gmock.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"
#include "transport/keys/allow_list.hpp"

namespace lightnet::renewal_test {
namespace {

using namespace std::chrono_literals;
using namespace test;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto line_life = 200ms;

// Passes light on, and takes its time.
class Slow final : public LightOp {
public:
    explicit Slow(const NodeContext& here) : inputs_(here.inputs()) {}
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::this_thread::sleep_for(150ms);
        for (const Part& part : ask_all(inputs_, questions)) add(part, answers);
    }

private:
    Inputs inputs_;
};

Registry with_slow() {
    auto kinds = standard_nodes();
    Kind slow{.name = "Slow", .help = "passes light on", .inputs = {1, 1}};
    slow.make_light = [](const NodeContext& here) { return std::make_unique<Slow>(here); };
    kinds.push_back(std::move(slow));
    return Registry(std::move(kinds));
}

std::vector<Node> nodes() {
    const auto ref = [](const char* name) { return Value{NodeRef{name}}; };
    return {node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("direct", "DirectLighting", {}),
            node("slow", "Slow", {ref("direct")}), node("image", "RayTracer", {ref("slow")}, seen())};
}

TEST(OldLines, AreReplacedWithoutTheLossOfAByte) {
    Learning learning{with_slow(), nodes()};
    const auto expected = learning.serial();
    const Registry kinds = with_slow();
    const Folder folder;
    const auto user = KeyPair::random();
    const auto keyed = [&](const std::string& name, const KeyPair& own) {
        Host::Options options;
        options.places = 1;
        options.cache = folder.file(name);
        options.key = own;
        options.allow = user.open.text();
        options.line_life = line_life;
        return options;
    };
    const auto first = KeyPair::random(), second = KeyPair::random();
    HostThread one(kinds, keyed("one", first)), two(kinds, keyed("two", second));
    auto options = cluster_of(learning, {one.endpoint(), two.endpoint()});
    std::string said;
    options.say = [&](const std::string& text) { said += text + "\n"; };
    options.key = user;
    options.host_keys = {{one.endpoint(), first.open}, {two.endpoint(), second.open}};
    options.line_life = line_life;
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(test::slowdown * 20s, never);
    EXPECT_EQ(learning.networked(cluster), expected);
    EXPECT_GE(cluster.renewed_lines(), 2u) << "or nothing was shown";
    cluster.finish();
    EXPECT_THAT(said, Not(HasSubstr("is lost")));
    EXPECT_THAT(said, Not(HasSubstr("takes no part")));
}

}  // namespace
}  // namespace lightnet::renewal_test
