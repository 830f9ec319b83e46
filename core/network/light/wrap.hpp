// Makes a node of a class that was written for something else: one question at a time, one caller, members that change.
//
// A library is introduced once, by a Bridge for its classes: how an instance is made, how it is asked, and how it asks
// its inputs. From then on a class is one line of a registry: wrap<old::Gatherer>("OldGatherer", {.help = "…"}).
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
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
/// (const NodeContext&, OneByOne&) and owns an instance of T; both arguments outlive it. It has
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
    bool reproducible = true;    // false: it draws random numbers that can't be seeded; the run says so
    std::size_t at_once = 2048;  // instances that a call may have waiting at a time
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

/// A kind of node that is made of T.
template <class T>
Kind wrap(std::string name, Wrapping wrapping) {
    static_assert(AnswersQuestions<T> || SamplesPixels<T>, "this class has no lightnet::Bridge that can ask it");
    class InstanceOfT final : public WrappedInstance {
    public:
        explicit InstanceOfT(const NodeContext& here) : one_by_one_(here), bridge_(here, one_by_one_) {}
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
        OneByOne one_by_one_;
        Bridge<T> bridge_;
    };
    auto make = [](const NodeContext& here) -> std::unique_ptr<WrappedInstance> {
        return std::make_unique<InstanceOfT>(here);
    };
    if constexpr (AnswersQuestions<T>)
        return wrapped_light(std::move(name), std::move(wrapping), make);
    else
        return wrapped_renderer(std::move(name), std::move(wrapping), make);
}

}  // namespace lightnet
