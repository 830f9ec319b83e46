// Things that one run leaves to the next.
#include "tools/session/handover.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/network/graph/check.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/scene/data/identity.hpp"
#include "nodes/standard_nodes.hpp"

namespace lightnet::handover_test {
namespace {

Value list(double r, double g, double b) {
    Table table;
    table.list = {Value{r}, Value{g}, Value{b}};
    return {table};
}
Value named(const std::string& name, Value value) {
    Table table;
    table.named[name] = std::move(value);
    return {table};
}

class HandoverTest : public ::testing::Test {
protected:
    using Params = std::map<std::string, Value>;

    Job job(const Params& params) const {
        Job job;
        job.graph.file = "g.lua";
        job.scene = LIGHTNET_SOURCE_DIR "/graphs/cornell_box.pbrt";
        job.graph.nodes = {{"scene", "Scene", {Value{job.scene}}, params, {}},
                           {"light", "DirectLighting", {}, {}, {}},
                           {"image", "RayTracer", {Value{NodeRef{"light"}}}, {{"scene", Value{NodeRef{"scene"}}}}, {}}};
        Table film;
        film.list = {Value{16.0}, Value{16.0}};
        film.named = {{"file", Value{std::string("x.exr")}}};
        job.graph.nodes.back().params.emplace("film", Value{film});
        job.graph = check(job.graph, registry);
        job.isa = usual_isa();
        job.width = job.height = 16;
        return job;
    }
    LoadedScene load(const Job& job) const {
        DiskFiles files;
        return load_scene(job.graph, registry, files, job.scene);
    }
    std::shared_ptr<const Scene> built(const Job& job) const {
        return std::make_shared<const Scene>(load(job).data, SceneOptions{job.isa, job.width, job.height});
    }
    // As a run of that job would leave it.
    void leave(const Job& job, bool is_built) {
        handover.hold(job, registry, std::make_shared<ReadScene>());
        is_built ? handover.hold(built(job)) : handover.hold(load(job).data);
    }
    void expect(const std::optional<LoadedScene>& found, const Job& job, const char* what) const {
        ASSERT_TRUE(found) << what;
        const auto wanted = built(job);
        const Scene given = found->built ? Scene(*found->built, whole) : Scene(found->data, {job.isa, 16, 16});
        EXPECT_EQ(identity_of(given.data()), identity_of(wanted->data())) << what;
        EXPECT_EQ(given.seen_from().fov, wanted->seen_from().fov) << what;
        EXPECT_EQ(given.film().scale, wanted->film().scale) << what;
    }

    const SceneView whole{};
    const Registry registry{standard_nodes()};
    const Params narrow{{"camera", named("fov", Value{20.0})}};
    const Params bright{{"lamps", named("black", Value{2.0})}, {"colours", named("red", list(0, 0.5, 1))}};
    Handover handover;
};

TEST_F(HandoverTest, GivesTheSceneAsItWasLookedAtLast) {
    leave(job({}), true);
    expect(handover.take(job(narrow), registry), job(narrow), "another camera");
    expect(handover.take(job(narrow), registry), job(narrow), "the run before ended before it held anything");
    expect(handover.take(job({}), registry), job({}), "as it was");
}

TEST_F(HandoverTest, EditsWhatWasRead) {
    for (const bool is_built : {true, false}) {
        const auto next = [&](const Job& wanted, const char* what) {
            auto found = handover.take(wanted, registry);
            expect(found, wanted, what);
            if (!is_built && found) handover.hold(std::move(found->data));
        };
        leave(job({}), is_built);
        next(job(bright), "edited");
        auto both = bright;
        both.insert(narrow.begin(), narrow.end());
        next(job(both), "edited before, another camera");
        next(job({{"lamps", named("*", Value{0.0})}}), "edited again");
        next(job({}), "as it was");
    }
}

TEST_F(HandoverTest, HoldsNothingOfAnEditThatIsWrong) {
    const Job wrong = job({{"lamps", named("blakc", Value{2.0})}});
    for (const bool is_built : {true, false}) {
        leave(job(bright), is_built);
        EXPECT_THROW(handover.take(wrong, registry), UserError);
        if (auto found = handover.take(job(bright), registry)) expect(found, job(bright), "what was there before");
    }
}

}  // namespace
}  // namespace lightnet::handover_test
