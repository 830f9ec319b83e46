#include "core/network/light/wrap.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstring>
#include <functional>
#include <span>

#include "core/base/error.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/unwanted.hpp"
#include "core/base/words_of.hpp"
#include "core/network/light/describe_question.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/locks.hpp"
#include "core/network/light/renderer.hpp"

namespace lightnet {
namespace {

/// Instances of one node that nobody uses now. There are never more than calls that wait at a time.
class Pool {
public:
    Pool(const NodeContext& here, MakeInstance make) : here_(here), make_(std::move(make)) {}

    std::unique_ptr<WrappedInstance> fresh() const { return make_(here_); }
    std::unique_ptr<WrappedInstance> take() {
        if (idle_.empty()) return fresh();
        auto instance = std::move(idle_.back());
        idle_.pop_back();
        return instance;
    }
    // One whose call has thrown may be left in any state, and does not come back.
    void give_back(std::unique_ptr<WrappedInstance> instance) { idle_.push_back(std::move(instance)); }

private:
    const NodeContext& here_;
    MakeInstance make_;
    std::vector<std::unique_ptr<WrappedInstance>> idle_;
};

std::string describe(const PixelSample& sample) {
    return fmt::format("sample {} at pixel ({}, {})", sample.sample, sample.x, sample.y);
}

Rgb ask(WrappedInstance& instance, const Query& question) { return instance.light(question); }
Rgb ask(WrappedInstance& instance, const PixelSample& sample) { return instance.sample(sample); }

// Names the question when the class throws, whatever it throws.
template <class Question>
Rgb ask_named(WrappedInstance& instance, const Question& question) try {
    return ask(instance, question);
} catch (const Cancelled&) {
    throw;
} catch (const std::exception& error) {
    throw Error(describe(question), words_of(error));
} catch (...) {
    throw Error(describe(question), "threw what is no std::exception");
}

// The questions that are asked again in a checking run: chosen and ordered by their keys alone.
template <class QuestionAt>
std::vector<std::size_t> sample_of(std::size_t count, const QuestionAt& question_at) {
    constexpr std::uint64_t one_in = 8;
    std::vector<std::pair<std::uint64_t, std::size_t>> chosen;
    for (std::size_t i = 0; i < count; ++i) {
        const auto question = question_at(i);
        const auto key = mix(question.stream + 0x9e3779b97f4a7c15ull * question.sample);
        if (key % one_in == 0) chosen.emplace_back(key, i);
    }
    std::sort(chosen.begin(), chosen.end());
    std::vector<std::size_t> order;
    for (const auto& [key, i] : chosen) order.push_back(i);
    return order;
}

/// What light operators and renderers have in common. Its members change while light() is const: they are what the
/// instances of a node are kept in, not what its answers depend on, and nobody waits while they change.
class Wrapped {
public:
    Wrapped(const NodeContext& here, const Wrapping& wrapping, MakeInstance make)
        : here_(here),
          at_once_(wrapping.at_once),
          check_(here.checking() && wrapping.reproducible),
          alone_(wrapping.alone.empty() ? "" : wrapping.alone + " of " + here.whereabouts().process),
          pool_(here_, std::move(make)) {}

    template <class QuestionAt>
    void answer(const QuestionAt& question_at, std::span<Rgb> answers) {
        auto work = [&](std::size_t i) {
            auto instance = pool_.take();
            answers[i] = ask_named(*instance, question_at(i));
            pool_.give_back(std::move(instance));
        };
        std::optional<Locks::Held> held;
        if (!alone_.empty()) held.emplace(here_.locks().hold(alone_));
        each(answers.size(), work);
        if (check_) check(question_at, answers);
    }

private:
    // Who is alone asks nobody: nothing can go on while it waits.
    template <class Work>
    void each(std::size_t count, Work& work) const {
        if (alone_.empty()) return here_.each(count, at_once_, std::ref(work));
        for (std::size_t i = 0; i < count; ++i) work(i);
    }

    // Asks a sample once more, in another order, each question of an instance that has answered nothing yet.
    template <class QuestionAt>
    void check(const QuestionAt& question_at, std::span<const Rgb> answers) const {
        const auto order = sample_of(answers.size(), question_at);
        auto work = [&](std::size_t k) {
            const auto question = question_at(order[k]);
            const auto instance = pool_.fresh();
            const Rgb again = ask_named(*instance, question);
            if (std::memcmp(&again, &answers[order[k]], sizeof again) != 0)
                throw Error(describe(question),
                            "a fresh instance answers differently: what the class remembers must not change answers");
        };
        each(order.size(), work);
    }

    NodeContext here_;
    std::size_t at_once_;
    bool check_;
    std::string alone_;  // a lock; empty: none
    Pool pool_;
};

class WrappedLight final : public LightOp {
public:
    WrappedLight(const NodeContext& here, const Wrapping& wrapping, MakeInstance make)
        : wrapped_(std::make_unique<Wrapped>(here, wrapping, std::move(make))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        wrapped_->answer([&](std::size_t i) { return questions[i]; }, answers);
    }

private:
    std::unique_ptr<Wrapped> wrapped_;
};

/// Follows the rays of a tile concurrently, and adds them up in the order of samples.
class WrappedRenderer final : public Renderer {
public:
    WrappedRenderer(const NodeContext& here, const Wrapping& wrapping, MakeInstance make)
        : here_(here), wrapped_(std::make_unique<Wrapped>(here, wrapping, std::move(make))) {}

    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        std::vector<std::size_t> wanted;
        for (std::uint32_t pixel = 0; pixel < tile.pixels(); ++pixel)
            if (tile.looks_at(tile.x + pixel % tile.width, tile.y + pixel / tile.width)) wanted.push_back(pixel);
        std::vector<Rgb> found(wanted.size() * tile.samples);
        const auto sample = [&](std::size_t i) { return sample_at(tile, wanted[i / tile.samples], i % tile.samples); };
        wrapped_->answer(sample, found);
        for (std::size_t i = 0; i < found.size(); ++i) pixels[wanted[i / tile.samples]] += found[i];
    }

private:
    PixelSample sample_at(const Tile& tile, std::size_t pixel, std::size_t i) const {
        const auto x = tile.x + static_cast<std::uint32_t>(pixel % tile.width);
        const auto y = tile.y + static_cast<std::uint32_t>(pixel / tile.width);
        const Key key = pixel_key(here_.seed(), x, y);
        const auto sample = tile.first_sample + static_cast<std::uint32_t>(i);
        const Vec2 u = Samples(key, sample).next_2d();
        return {float(x) + u.x, float(y) + u.y, key, sample, here_.pass_mark(sample)};
    }

    NodeContext here_;
    std::unique_ptr<Wrapped> wrapped_;
};

Kind kind_of(std::string name, const Wrapping& wrapping) {
    Kind kind;
    kind.name = std::move(name);
    kind.help = wrapping.help;
    kind.inputs = wrapping.inputs;
    kind.params = wrapping.params;
    kind.run.whole_calls = true;
    kind.run.reproducible = wrapping.reproducible;
    kind.run.locks = !wrapping.alone.empty();
    kind.reads = reading(wrapping.reads);
    return kind;
}

}  // namespace

void OneByOne::begin(Key stream, std::uint32_t sample, std::uint16_t pass) {
    stream_ = child(stream, key_, sample);
    pass_ = pass;
    asked_ = 0;
}

Rgb OneByOne::ask(std::size_t index, Query question) {
    question.stream = child(stream_, key_, ++asked_);
    question.pass = pass_;
    return ask_one(inputs_[index], question);
}

Rgb OneByOne::ask(std::size_t index, const std::optional<Query>& question) {
    if (question) return ask(index, *question);
    here_.count_off_surface();
    return {};
}

Argument<int> count(std::string name, std::string help, double initial) {
    return {{.name = std::move(name),
             .type = ParamType::integer,
             .help = std::move(help),
             .initial = Value{initial},
             .least = 1,
             .most = 65536}};
}

Argument<double> amount(std::string name, std::string help, double initial) {
    return {{.name = std::move(name), .help = std::move(help), .initial = Value{initial}, .least = 0}};
}

Rgb WrappedInstance::light(const Query&) { throw Error("a renderer was asked for light"); }
Rgb WrappedInstance::sample(const PixelSample&) { throw Error("a light operator was asked for pixels"); }

Kind wrapped_light(std::string name, Wrapping wrapping, MakeInstance make) {
    Kind kind = kind_of(std::move(name), wrapping);
    kind.light.lamps = true;
    kind.make_light = [wrapping = std::move(wrapping), make = std::move(make)](const NodeContext& here) {
        return std::make_unique<WrappedLight>(here, wrapping, make);
    };
    return kind;
}

Kind wrapped_renderer(std::string name, Wrapping wrapping, MakeInstance make) {
    Kind kind = kind_of(std::move(name), wrapping);
    kind.role = Role::image;
    kind.light.merges = true;
    const std::vector<Param> image{
        {.name = "scene", .type = ParamType::scene, .help = "what is found"},
        {.name = "film", .type = ParamType::film, .help = "width, height, and file of the image"},
        {.name = "samples",
         .type = ParamType::integer,
         .help = "samples per pixel",
         .unit = "samples",
         .initial = Value{16.0},
         .least = 1,
         .most = 1 << 24}};
    kind.params.insert(kind.params.begin(), image.begin(), image.end());
    kind.make_renderer = [wrapping = std::move(wrapping), make = std::move(make)](const NodeContext& here) {
        return std::make_unique<WrappedRenderer>(here, wrapping, make);
    };
    return kind;
}

}  // namespace lightnet
