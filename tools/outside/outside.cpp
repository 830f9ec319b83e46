#include "tools/outside/outside.hpp"

#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/math/sampling.hpp"
#include "core/estimate/question_batch.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "tools/outside/outside_line.hpp"

namespace lightnet {
namespace {

constexpr std::size_t longest_text = 65536;

/// What one message says, read from its beginning.
class Reading {
public:
    explicit Reading(const OutsideLine::Message& message) : left_(message.data) {}

    std::uint32_t number() { return take<std::uint32_t>(); }
    float real() { return take<float>(); }
    template <class Entry>
    std::vector<Entry> column(std::size_t count) {
        std::vector<Entry> entries(count);
        copy(entries.data(), count * sizeof(Entry));
        return entries;
    }
    void end() const {
        if (!left_.empty()) wrong();
    }

private:
    [[noreturn]] static void wrong() { throw Error("a function from outside sent a message of the wrong length"); }
    template <class T>
    T take() {
        T value{};
        copy(&value, sizeof value);
        return value;
    }
    void copy(void* to, std::size_t bytes) {
        if (bytes > left_.size()) wrong();
        if (bytes) std::memcpy(to, left_.data(), bytes);
        left_ = left_.subspan(bytes);
    }

    std::span<const std::byte> left_;
};

/// One call, from its questions to its answer.
class OutsideCall {
public:
    OutsideCall(OutsideLine& line, QuestionBatch& questions, std::size_t inputs)
        : line_(line), questions_(questions), inputs_(inputs) {}

    void answer(const std::string& function, std::span<Rgb> answers) {
        open(function);
        while (true) {
            const auto message = line_.hear(longest_text + questions_.size() * 2 * sizeof(Vec3));
            if (message.kind == 'e')
                throw Error(std::string(reinterpret_cast<const char*>(message.data.data()), message.data.size()));
            if (message.kind == 'v') return take(message, answers);
            serve(message.kind, Reading(message));
        }
    }

private:
    void open(const std::string& function) {
        const std::uint32_t sizes[] = {static_cast<std::uint32_t>(questions_.size()),
                                       static_cast<std::uint32_t>(inputs_)};
        std::vector<std::byte> head(sizeof sizes + function.size());
        std::memcpy(head.data(), sizes, sizeof sizes);
        std::memcpy(head.data() + sizeof sizes, function.data(), function.size());
        line_.send('q', head);
    }
    void take(const OutsideLine::Message& message, std::span<Rgb> answers) const {
        Reading reading(message);
        if (message.data.size() == answers.size() * sizeof(float)) {
            const auto grey = reading.column<float>(answers.size());
            for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = {grey[i], grey[i], grey[i]};
        } else {
            const auto values = reading.column<Rgb>(answers.size());
            for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = values[i];
        }
        reading.end();
    }

    void serve(char kind, Reading reading) {
        const std::size_t count = questions_.size();
        if (kind == 'p') return tell([&](std::size_t i) { return questions_.places()[i].point.position; });
        if (kind == 'n') return tell([&](std::size_t i) { return questions_.places()[i].up; });
        if (kind == 'o') return tell([&](std::size_t i) { return questions_[i].outgoing; });
        if (kind == 'a') return tell([&](std::size_t i) { return questions_.albedo(i); });
        if (kind == 'r') {
            const auto which = reading.number(), of = reading.number();
            return tell([&](std::size_t i) { return questions_.random(i, which, of); });
        }
        if (kind == 'h') {
            const auto normals = reading.column<Vec3>(count);
            const auto points = reading.column<Vec2>(count);
            return tell(
                [&](std::size_t i) { return Frame::around(normals[i]).to_world(cosine_hemisphere(points[i])); });
        }
        if (kind == 'f') {
            const float distance = reading.real();
            const auto directions = reading.column<Vec3>(count);
            return tell([&](std::size_t i) { return questions_.open(i, directions[i], distance) ? 1.0f : 0.0f; });
        }
        if (kind == 'i') return tell(questions_.ask(input(reading)));
        if (kind == 'd') {
            const auto index = input(reading);
            return tell(questions_.ask(index, reading.column<Vec3>(count)));
        }
        throw Error("a function from outside sent an unknown request");
    }
    std::size_t input(Reading& reading) const {
        const auto index = reading.number();
        if (index >= inputs_) throw Error("a function from outside asks an input that it does not have");
        return index;
    }

    template <class Entry>
    void tell(const std::vector<Entry>& column) {
        line_.send('c', std::as_bytes(std::span(column)));
    }
    template <class Make>
    requires std::invocable<Make, std::size_t>
    void tell(const Make& make) {
        std::vector<decltype(make(std::size_t{}))> column;
        column.reserve(questions_.size());
        for (std::size_t i = 0; i < questions_.size(); ++i) column.push_back(make(i));
        tell(column);
    }

    OutsideLine& line_;
    QuestionBatch& questions_;
    std::size_t inputs_;
};

/// A function of another process. Each call that goes on has a line of its own.
class Outside final : public LightOp {
public:
    explicit Outside(const NodeContext& here)
        : function_(here.text("function")), scene_(here.scene()), inputs_(here.inputs()), key_(here.key()) {
        const char* const socket = std::getenv("LIGHTNET_OUTSIDE");
        if (!socket)
            throw Error("Outside '" + here.name() +
                        "' is answered by the process that starts a run, and LIGHTNET_OUTSIDE names none");
        socket_ = socket;
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        auto line = spare();
        QuestionBatch batch(scene_, inputs_, key_, questions);
        OutsideCall(*line, batch, inputs_.size()).answer(function_, answers);
        spare_.push_back(std::move(line));  // not after an exception: who knows what is still in it
    }

private:
    std::unique_ptr<OutsideLine> spare() const {
        if (spare_.empty()) return std::make_unique<OutsideLine>(socket_);
        auto line = std::move(spare_.back());
        spare_.pop_back();
        return line;
    }

    std::string function_, socket_;
    const Scene& scene_;
    Inputs inputs_;
    Key key_;
    mutable std::vector<std::unique_ptr<OutsideLine>> spare_;  // between calls
};

}  // namespace

Kind outside_kind() {
    return {.name = "Outside",
            .help = "a function of the process that started this run, such as Python's: columns in, columns out",
            .inputs = {0, 64},
            .params = {{.name = "function", .type = ParamType::text, .help = "what that process knows it by"}},
            .light = {.paths = always({}), .onward = ""},
            .make_light = [](const NodeContext& here) { return std::make_unique<Outside>(here); }};
}

}  // namespace lightnet
