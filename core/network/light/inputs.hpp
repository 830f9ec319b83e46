// The inputs that a node's constructor is given.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/film/addition.hpp"
#include "core/network/light/port.hpp"

namespace lightnet {

/// One input of a node, in the order in which the graph lists them.
struct Input {
    std::string name;                      // of the node that answers
    Port* port = nullptr;                  // owned by the place; null: the answer is black, and nobody is asked
    std::vector<std::uint32_t> layers{0};  // which of the asker's layers each colour of an answer belongs to

    bool facts = false;     // gives no light: see LightTraits
    std::uint32_t ids = 0;  // its facts are ids, of which the asker's layers keep so many, from the first one on

    std::size_t width() const { return layers.size(); }
};

/// All inputs of one node.
class Inputs {
public:
    Inputs() = default;
    Inputs(std::vector<Input> inputs, std::size_t layers, std::vector<std::uint32_t> halved = {})
        : inputs_(std::move(inputs)), layers_(layers), halved_(std::move(halved)) {}

    std::size_t size() const { return inputs_.size(); }
    bool empty() const { return inputs_.empty(); }
    const Input& operator[](std::size_t i) const { return inputs_[i]; }
    auto begin() const { return inputs_.begin(); }
    auto end() const { return inputs_.end(); }
    /// Those that give facts, or those that give light.
    Inputs which(bool facts) const;
    /// How many colours an answer of the node itself has: one per layer of the image that it adds to.
    std::size_t layers() const { return layers_; }
    /// Of a renderer: of which of those colours it keeps the second half of the samples, too. Those halves are its last
    /// ones but alpha, in this order.
    const std::vector<std::uint32_t>& halved() const { return halved_; }
    /// How such answers are added up, one for the other.
    Addition addition() const;

private:
    std::vector<Input> inputs_;
    std::size_t layers_ = 1;
    std::vector<std::uint32_t> halved_;
};

/// What one input answered: `input->width()` colours per question, next to each other.
struct Part {
    const Input* input = nullptr;
    std::size_t index = 0;   // of the input
    std::size_t layers = 1;  // of the asker
    std::vector<Rgb> answers;
};

/// Asks all inputs the same questions; all are asked before any is awaited. Those that are black have no part.
std::vector<Part> ask_all(const Inputs& inputs, std::span<const Query> questions);

/// Asks one input.
Part ask(const Inputs& inputs, std::size_t index, std::span<const Query> questions);

/// Asks one input one question. No colour of the answer is kept apart: only for an input of one colour.
Rgb ask_one(const Input& input, const Query& question);

/// Calls with(question, layer, colour) for each colour of a part; the layer is the asker's.
template <class With>
void each_colour(const Part& part, With&& with) {
    const std::size_t width = part.input->width(), questions = part.answers.size() / width;
    for (std::size_t q = 0; q < questions; ++q)
        for (std::size_t k = 0; k < width; ++k) with(q, part.input->layers[k], part.answers[q * width + k]);
}

/// answers += weight × part, each colour into its own layer.
inline void add(const Part& part, std::span<Rgb> answers, float weight = 1) {
    each_colour(part, [&](std::size_t q, std::size_t layer, const Rgb& colour) {
        answers[q * part.layers + layer] += colour * weight;
    });
}

}  // namespace lightnet
