// Path guiding: learns beforehand where light comes from, for path tracing.
#include <algorithm>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/estimate/guide_trial.hpp"
#include "core/estimate/light_guide.hpp"
#include "core/estimate/path_walk.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/rehearsal.hpp"
#include "core/network/light/services.hpp"

namespace lightnet {
namespace {

constexpr std::size_t rounds = guide_rounds;
constexpr std::size_t compared = 4;       // of so many paths one goes by surfaces alone
constexpr double work_of_lesson = 2.6;    // of a path that is learnt from, in paths of the picture: measured
constexpr double least_of_lessons = 4.5;  // times as many paths has a picture that is worth its first round

// DECISIONS: lessons-have-a-price
// All a guide can take away is noise: there must be more of it where a larger part of the picture's work is still to
// be done for it.
bool may_pay(const GuideTrial::Gain& noise, double left) { return noise.times - noise.error >= 4 * left * left; }

using RoundsOfPaths = std::vector<Mapped<GuideRecord>>;  // of each: directions and, between them, whole paths

std::size_t count_of(const RoundsOfPaths& found) {
    std::size_t count = 0;
    for (const auto& round : found)
        count += std::size_t(std::count_if(round.begin(), round.end(), LightGuide::learns_from));
    return count;
}

GuideTrial trial_of(const RoundsOfPaths& found, std::size_t points) {
    GuideTrial trial(points);
    for (const auto& round : found)
        for (const GuideRecord& record : round) trial.add(record, &round == &found.back());
    return trial;
}
/// Of paths that nobody guides.
GuideTrial::Gain noise_of(Services& services, const RoundsOfPaths& found, std::size_t points) {
    return *services.once<GuideTrial::Gain>([&] { return trial_of(found, points).noise_alone(); });
}
/// Of the paths that the last round guided, beside all that nobody did.
GuideTrial::Gain gain_of(Services& services, const RoundsOfPaths& found, std::size_t points) {
    return *services.once<GuideTrial::Gain>([&] { return trial_of(found, points).gain(); });
}

/// Müller, Gross & Novák 2017, "Practical Path Guiding for Efficient Light-Transport Simulation": follows light paths
/// in rounds, each of twice as many as the one before and guided by what all before have found. It begins where path
/// tracing that takes it is asked, in rehearsals. The first round, and some paths of each, nobody guides: guided ones
/// are compared with them, and where they don't find more for the same work, nobody is guided. Pictures have no bias by
/// it, however wrong it may be.
class Guide final : public LightOp {
public:
    explicit Guide(const NodeContext& here)
        : rehearsal_(here.rehearsal()),
          key_(here.key()),
          walk_(here.scene(), {.all = true}),
          paths_(static_cast<std::size_t>(here.integer("paths"))),
          picture_(static_cast<double>(here.integer("picture"))),
          always_(here.text("when") == "always"),
          kept_(here.kept()),
          keeps_(!here.text("keep").empty()) {}

    void prepare(Services& services) override {
        RoundsOfPaths found = older();
        const bool goes_on = !found.empty(), tries = !always_ && !goes_on;
        auto guide = goes_on ? made(services, found) : nullptr;
        bool helps = !tries || picture_ == 0 || picture_ >= least_of_lessons * double(paths_);
        const std::vector<Query> questions = helps ? points(services) : std::vector<Query>();
        std::vector<GuideTrial::Gain> gains;
        GuideTrial::Gain noise;
        for (std::size_t round = 0; round < rounds && helps && !questions.empty(); ++round) {
            found.push_back(learn(services, {questions, round, guide.get(), tries}));
            if (tries && round == 0) {
                noise = noise_of(services, found, questions.size());
                helps = picture_ == 0 || may_pay(noise, work_after_first() / picture_);
            } else if (tries) {
                gains.push_back(gain_of(services, found, questions.size()));
                helps = guide_pays(gains, noise.times);
            }
            if (helps) guide = made(services, found);
        }
        if (!helps && found.empty())
            services.say("the picture has too few paths to learn from others: they go on by surfaces alone");
        else
            services.say(std::to_string(count_of(found)) + " directions in " +
                         std::to_string(guide ? guide->size() : 0) + " places" +
                         (helps ? "" : ", which help too little: paths go on by surfaces alone"));
        if (keeps_) keep(services, found);
        guide_ = helps && guide ? guide : std::make_shared<const LightGuide>();
    }

    void light(std::span<const Query> questions, std::span<Rgb>) const override {
        for (const Query& question : questions) rehearsal_.note(question);
    }

    Frozen frozen() const override { return Frozen(guide_); }

private:
    struct Round {
        std::span<const Query> questions;
        std::size_t number;
        const LightGuide* guide;
        bool tries;  // with paths that go by surfaces alone, at all points in turn: the others are compared with them
    };

    // In the order of their keys, which is none: all over the image.
    static std::vector<Query> points(Services& services) {
        std::vector<Query> questions;
        for (std::uint32_t stride = coarsest; stride > 0 && questions.size() < most_points; stride /= 2)
            questions = services.rehearse(stride);
        if (questions.size() > most_points) questions.resize(most_points);
        return questions;
    }

    std::size_t first_path(std::size_t round) const {
        return std::max<std::size_t>(1, paths_ / ((1u << rounds) - 1)) * ((1u << round) - 1);
    }

    static bool follows(const Round& round, std::size_t path) {
        return round.guide && (!round.tries || (path + path / round.questions.size()) % compared > 0);
    }

    /// Follows the paths of one round, on all places.
    Mapped<GuideRecord> learn(Services& services, const Round& round) const {
        services.doing("follows paths, round " + std::to_string(round.number + 1) + " of " + std::to_string(rounds));
        const std::size_t first = first_path(round.number), last = first_path(round.number + 1);
        const auto asked = [&](std::size_t path) {
            Query question = round.questions[path % round.questions.size()];
            question.sample = static_cast<std::uint32_t>(path / round.questions.size());
            return question;
        };
        return services.map<GuideRecord>(
            (last - first + paths_per_shard - 1) / paths_per_shard, [&](std::size_t shard, auto& out) {
                const std::size_t begin = first + shard * paths_per_shard;
                const std::size_t end = std::min(last, begin + paths_per_shard);
                for (const bool guided : {false, true}) {
                    std::vector<Query> some;
                    std::vector<std::uint32_t> points;
                    for (std::size_t path = begin; path < end; ++path) {
                        if (guided != follows(round, path)) continue;
                        some.push_back(asked(path));
                        points.push_back(static_cast<std::uint32_t>(path % round.questions.size()));
                    }
                    Learnt learnt;
                    walk_.learn(some, child(key_, key_, round.number), guided ? round.guide : nullptr, learnt);
                    out.insert(out.end(), learnt.records.begin(), learnt.records.end());
                    for (std::size_t i = 0; i < points.size(); ++i)
                        out.push_back(GuideTrial::record_of({learnt.paths[i], points[i], guided}));
                }
            });
    }

    double work_after_first() const { return work_of_lesson * double(first_path(rounds) - first_path(1)); }

    static std::shared_ptr<const LightGuide> made(Services& services, const RoundsOfPaths& found) {
        services.doing("builds its tree");
        return services.once<LightGuide>([&](Builders& builders) {
            std::vector<std::span<const GuideRecord>> lots;
            for (const auto& round : found) lots.push_back(round.all());
            return LightGuide(lots, builders);
        });
    }

    // What an earlier run has kept of the same scene.
    RoundsOfPaths older() const {
        RoundsOfPaths found;
        if (!kept_) return found;
        found.emplace_back(kept_);
        const auto wrong = [](const GuideRecord& record) { return !LightGuide::learns_from(record); };
        if (std::any_of(found[0].begin(), found[0].end(), wrong))
            throw Error("'extend' names a file with directions of light that no path can have found");
        if (found[0].size() == 0) found.clear();
        return found;
    }

    // The result of the last call is what is kept.
    static void keep(Services& services, const RoundsOfPaths& found) {
        std::vector<GuideRecord> records;
        for (const auto& round : found)
            std::copy_if(round.begin(), round.end(), std::back_inserter(records), LightGuide::learns_from);
        services.map<GuideRecord>(
            (records.size() + records_per_shard - 1) / records_per_shard, [&](std::size_t shard, auto& out) {
                const auto some = std::span(records).subspan(shard * records_per_shard);
                out.assign(some.begin(), some.begin() + std::ptrdiff_t(std::min(some.size(), records_per_shard)));
            });
    }

    static constexpr std::uint32_t coarsest = 8;          // pixels between points of the first rehearsal
    static constexpr std::size_t most_points = 4096;      // at which paths begin
    static constexpr std::size_t paths_per_shard = 1024;  // some ms
    static constexpr std::size_t records_per_shard = 65536;

    Rehearsal& rehearsal_;
    Key key_;
    PathWalk walk_;
    std::size_t paths_;
    double picture_;  // paths of it; 0: not known
    bool always_;
    Bytes kept_;  // what an earlier run has kept of the same scene
    bool keeps_;
    std::shared_ptr<const LightGuide> guide_;  // null: it has not prepared yet
};

std::vector<Param> guide_params() {
    return {
        {.name = "paths",
         .type = ParamType::integer,
         .help = "light paths that it learns from",
         .unit = "paths",
         .initial = Value{150000.0},
         .least = 64,
         .most = 1 << 24},
        {.name = "picture",
         .type = ParamType::integer,
         .help = "light paths of the picture, by which trials weigh what learning costs; 0: not known, they do without",
         .unit = "paths",
         .initial = Value{0.0},
         .least = 0,
         .most = 9e15},
        {.name = "when",
         .type = ParamType::text,
         .help = "when paths are guided: where trials say that it pays, or always",
         .initial = Value{"worthwhile"},
         .choices = {"worthwhile", "always"}},
        {.name = "extend",
         .type = ParamType::text,
         .help = "file of directions that a run has kept of this scene, to go on from; paths are then guided always; "
                 "empty: none",
         .initial = Value{""}},
        {.name = "keep",
         .type = ParamType::text,
         .help = "file in which all directions are kept for later runs, from the graph's folder; empty: none",
         .initial = Value{""}},
    };
}

}  // namespace

Kind guide_kind() {
    return {
        .name = "Guide",
        .help = "no light: learns where light comes from, for path tracing that takes it as its guide",
        .params = guide_params(),
        .light = {.paths = always({})},
        .run = {.prepares = true, .rehearses = true, .freezes = "light directions", .keeps = true},
        .reads = reading(scene_of_light),
        .make_light = [](const NodeContext& here) { return std::make_unique<Guide>(here); },
    };
}

}  // namespace lightnet
