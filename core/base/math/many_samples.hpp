// The random numbers of many streams that advance together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/math/samples.hpp"

namespace lightnet {

/// Many Samples, each with a key and an index of its own, from which numbers are drawn dimension by dimension, for far
/// less than one by one.
class ManySamples {
public:
    std::size_t size() const { return keys_.size(); }
    void add(Key key, std::uint32_t index) {
        keys_.push_back(key);
        indices_.push_back(index);
    }
    /// Stream `from` takes the place of stream `to`.
    void move(std::size_t from, std::size_t to) {
        keys_[to] = keys_[from];
        indices_[to] = indices_[from];
    }
    /// Keeps the first ones only.
    void keep(std::size_t count) {
        keys_.resize(count);
        indices_.resize(count);
    }

    /// What next() and next_2d() of each give when `dimension` numbers have been used.
    void draw(std::uint32_t dimension, std::vector<float>& values) const {
        values.resize(size());
        Samples::many(keys_, indices_, dimension, values);
    }
    void draw(std::uint32_t dimension, std::vector<Vec2>& points) const {
        points.resize(size());
        Samples::many_2d(keys_, indices_, dimension, points);
    }
    Samples at(std::size_t i, std::uint32_t dimension) const { return {keys_[i], indices_[i], dimension}; }

private:
    std::vector<Key> keys_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace lightnet
