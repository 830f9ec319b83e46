// Makes a node of a class that was written for something else: one question at a time, one caller, members that change.
//
// A library is introduced once, by a Bridge for its classes: how an instance is made, how it is asked, and how it asks
// its inputs. From then on a class is a line or two of a registry, which name what its constructor takes:
// wrap<old::Gatherer>("OldGatherer", {.help = "…"}, with(&Around::world, count("rays", "directions", 16))).
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/inputs.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {

/// One sample of a pixel, for a renderer that follows one ray at a time.
struct PixelSample {
    float x = 0, y = 0;        // on the image, in pixels from the upper left corner
    Key stream = 0;            // root of all random numbers of this sample
    std::uint32_t sample = 0;  // of the pixel
    std::uint16_t pass = 0;    // for Query::pass
};

/// Asks the inputs of a node on behalf of one instance: one question at a time, and the answer is there when it
/// returns. The keys of the questions are those of the question that is being answered, counted up, and of nothing
/// else.
class OneByOne {
public:
    explicit OneByOne(const NodeContext& here) : here_(here), inputs_(here.inputs()), key_(here.key()) {}

    std::size_t inputs() const { return inputs_.size(); }
    /// How bright is it there, says input `index`. Sets the question's stream and pass.
    Rgb ask(std::size_t index, Query question);
    /// How bright is it there, where there may be no surface to ask about? Black then, and counted. See
    /// SurfaceLookup::question().
    Rgb ask(std::size_t index, const std::optional<Query>& question);
    /// Seed for the random numbers that the class draws by itself while it answers what it is asked now.
    Key seed() const { return child(stream_, key_, 0); }
    /// An answer begins: `stream` is the root of its random numbers, for its sample with that index, in that pass.
    void begin(Key stream, std::uint32_t sample, std::uint16_t pass = 0);

private:
    const NodeContext& here_;
    Inputs inputs_;
    Key key_;
    Key stream_ = 0;
    std::uint16_t pass_ = 0;
    std::uint64_t asked_ = 0;
};

/// To be specialised, for one class or for all that some condition holds for. A Bridge<T> is constructed from
/// (const NodeContext&, OneByOne&) and owns an instance of T; both arguments outlive it. Where wrap() is told what T's
/// constructor takes, the Bridge is given a third argument: `make(around)` makes an instance, with what it finds in
/// `around`, an object of the Bridge's own. It has
///     Rgb light(const Query&)    if T is to be a light operator, or
///     Rgb sample(const PixelSample&)      if T is to be a renderer: the radiance that arrives, what shines by itself
///     included.
/// Either begins with seeding whatever draws random numbers, if anything does, from OneByOne::seed(). What an instance
/// remembers from one call to the next is scratch: history must not change answers.
template <class T>
struct Bridge;

template <class T>
concept AnswersQuestions = requires(Bridge<T>& bridge, const Query& question) {
    { bridge.light(question) } -> std::convertible_to<Rgb>;
};
template <class T>
concept SamplesPixels = requires(Bridge<T>& bridge, const PixelSample& sample) {
    { bridge.sample(sample) } -> std::convertible_to<Rgb>;
};

/// What graphs may say of a wrapped class.
struct Wrapping {
    std::string help;  // what it does, one line
    InputCount inputs = {};
    std::vector<Param> params = {};
    SceneParts reads = whole_scene;  // of the scene: see Kind::reads
    bool reproducible = true;        // false: it draws random numbers that can't be seeded; the run says so
    std::size_t at_once = 2048;      // instances that a call may have waiting at a time
    /// Of all calls of a process whose kinds name the same here, one at a time goes on: for libraries that change
    /// global variables. Such a class asks no inputs. Empty: calls don't disturb each other.
    std::string alone = {};
};

/// One instance of a wrapped class, whatever the class is. Used by one call at a time.
class WrappedInstance {
public:
    virtual ~WrappedInstance() = default;
    /// Of a light operator.
    virtual Rgb light(const Query& question);
    /// Of a renderer.
    virtual Rgb sample(const PixelSample& sample);
};

using MakeInstance = std::function<std::unique_ptr<WrappedInstance>(const NodeContext&)>;

/// The kind of a class by its instances; wrap() is the way to it.
Kind wrapped_light(std::string name, Wrapping wrapping, MakeInstance make);
Kind wrapped_renderer(std::string name, Wrapping wrapping, MakeInstance make);

/// An argument of a wrapped class's constructor that graphs set: a parameter of the node.
template <class T>
struct Argument {
    Param param;
};
/// From 1 to 65536.
Argument<int> count(std::string name, std::string help, double initial);
/// From 0.
Argument<double> amount(std::string name, std::string help, double initial);

/// What the constructor of a wrapped class takes, in its order; with() makes it.
template <class... Each>
class Arguments {
public:
    explicit Arguments(Each... each) : each_(std::move(each)...) {}

    void add_params(std::vector<Param>& params) const {
        std::apply([&](const auto&... each) { (add_param(params, each), ...); }, each_);
    }
    template <class T, class Around>
    T make(const NodeContext& here, Around& around) const {
        return std::apply([&](const auto&... each) { return T{value(here, around, each)...}; }, each_);
    }

private:
    template <class T>
    static void add_param(std::vector<Param>& params, const Argument<T>& argument) {
        params.push_back(argument.param);
    }
    template <class Around, class Member>
    static void add_param(std::vector<Param>&, Member Around::*) {}

    template <class Around, class Member>
    static Member& value(const NodeContext&, Around& around, Member Around::*member) {
        return around.*member;
    }
    template <class Around>
    static int value(const NodeContext& here, Around&, const Argument<int>& argument) {
        return static_cast<int>(here.integer(argument.param.name));
    }
    template <class Around>
    static double value(const NodeContext& here, Around&, const Argument<double>& argument) {
        return here.number(argument.param.name);
    }

    std::tuple<Each...> each_;
};

/// Members of what the Bridge keeps around an instance (`&Around::world`), which are handed on by reference, and
/// parameters of graphs (count(), amount()).
template <class... Each>
Arguments<Each...> with(Each... each) {
    return Arguments<Each...>(std::move(each)...);
}

/// A kind of node that is made of T. `arguments` are those of T's constructor; without any, the Bridge knows them.
template <class T, class... Each>
Kind wrap(std::string name, Wrapping wrapping, Arguments<Each...> arguments = Arguments<>()) {
    static_assert(AnswersQuestions<T> || SamplesPixels<T>, "this class has no lightnet::Bridge that can ask it");
    class InstanceOfT final : public WrappedInstance {
    public:
        InstanceOfT(const NodeContext& here, const Arguments<Each...>& arguments)
            : one_by_one_(here), bridge_(bridge(here, one_by_one_, arguments)) {}
        Rgb light([[maybe_unused]] const Query& question) override {
            if constexpr (AnswersQuestions<T>) {
                one_by_one_.begin(question.stream, question.sample, question.pass);
                return bridge_.light(question);
            }
            return WrappedInstance::light(question);
        }
        Rgb sample([[maybe_unused]] const PixelSample& at) override {
            if constexpr (SamplesPixels<T>) {
                one_by_one_.begin(at.stream, at.sample, at.pass);
                return bridge_.sample(at);
            }
            return WrappedInstance::sample(at);
        }

    private:
        static Bridge<T> bridge(const NodeContext& here, OneByOne& inputs, const Arguments<Each...>& arguments) {
            if constexpr (sizeof...(Each) == 0)
                return Bridge<T>(here, inputs);
            else
                return Bridge<T>(here, inputs, [&](auto& around) { return arguments.template make<T>(here, around); });
        }

        OneByOne one_by_one_;
        Bridge<T> bridge_;
    };
    arguments.add_params(wrapping.params);
    auto make = [arguments](const NodeContext& here) -> std::unique_ptr<WrappedInstance> {
        return std::make_unique<InstanceOfT>(here, arguments);
    };
    if constexpr (AnswersQuestions<T>)
        return wrapped_light(std::move(name), std::move(wrapping), make);
    else
        return wrapped_renderer(std::move(name), std::move(wrapping), make);
}

}  // namespace lightnet
