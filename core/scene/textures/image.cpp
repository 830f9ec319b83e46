#include "core/scene/textures/image.hpp"

#include <array>
#include <cassert>
#include <span>
#include <utility>

namespace lightnet {

Image::Image(std::uint32_t wide, std::uint32_t high, const std::vector<Rgb>& pixels, const std::vector<float>& alpha)
    : width(wide), height(high), channels_(alpha.empty() ? 3 : 4) {
    assert(pixels.size() == std::size_t{wide} * high && (alpha.empty() || alpha.size() == pixels.size()) &&
           "each pixel has its colour");
    auto& numbers = std::get<std::vector<float>>(numbers_);
    numbers.reserve(pixels.size() * channels_);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        numbers.insert(numbers.end(), {pixels[i].r, pixels[i].g, pixels[i].b});
        if (!alpha.empty()) numbers.push_back(alpha[i]);
    }
}

Image::Image(std::uint32_t wide, std::uint32_t high, Coded coded)
    : width(wide),
      height(high),
      channels_(coded.channels),
      curve_(std::move(coded.curve)),
      alpha_curve_(std::move(coded.alpha_curve)) {
    assert(channels_ >= 1 && channels_ <= 4 && "grey or RGB, with alpha or without");
    std::visit(
        [&](auto& numbers) {
            assert(numbers.size() == std::size_t{wide} * high * channels_ && "each pixel has its numbers");
            numbers_ = std::move(numbers);
        },
        coded.numbers);
}

float Image::number(std::size_t at, const Curve& curve) const {
    if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&numbers_)) return (*curve)[(*bytes)[at]];
    if (const auto* words = std::get_if<std::vector<std::uint16_t>>(&numbers_)) return (*curve)[(*words)[at]];
    return std::get<std::vector<float>>(numbers_)[at];
}

Rgb Image::colour(std::uint32_t x, std::uint32_t y) const {
    const std::size_t at = (std::size_t{y} * width + x) * channels_;
    const float first = number(at, curve_);
    if (channels_ < 3) return {first, first, first};
    return {first, number(at + 1, curve_), number(at + 2, curve_)};
}

// What the numbers are is asked once, not for each.
Image::Square Image::square(std::uint32_t left, std::uint32_t right, std::uint32_t above, std::uint32_t below) const {
    const std::size_t upper = std::size_t{above} * width, lower = std::size_t{below} * width;
    const auto all = [&](const auto& value) {
        const auto colour = [&](std::size_t pixel) {
            const std::size_t at = pixel * channels_;
            if (channels_ < 3) return Rgb{value(at), value(at), value(at)};
            return Rgb{value(at), value(at + 1), value(at + 2)};
        };
        return Square{colour(upper + left), colour(upper + right), colour(lower + left), colour(lower + right)};
    };
    const auto coded = [&](const auto& numbers) {
        return all([by = curve_->data(), from = numbers.data()](std::size_t at) { return by[from[at]]; });
    };
    if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&numbers_)) return coded(*bytes);
    if (const auto* words = std::get_if<std::vector<std::uint16_t>>(&numbers_)) return coded(*words);
    return all([from = std::get<std::vector<float>>(numbers_).data()](std::size_t at) { return from[at]; });
}

const float* Image::linear_rgb() const {
    const auto* numbers = std::get_if<std::vector<float>>(&numbers_);
    return numbers && channels_ == 3 ? numbers->data() : nullptr;
}

const void* Image::where(std::uint32_t x, std::uint32_t y) const {
    const std::size_t at = (std::size_t{y} * width + x) * channels_;
    return std::visit([&](const auto& numbers) -> const void* { return &numbers[at]; }, numbers_);
}

// Here and not in a function that visit() calls: that one would seem to do nothing, and compilers leave it out.
void Image::expect(std::uint32_t x, std::uint32_t y) const { __builtin_prefetch(where(x, y)); }

float Image::alpha(std::uint32_t x, std::uint32_t y) const {
    if (!has_alpha()) return 1;
    return number((std::size_t{y} * width + x) * channels_ + channels_ - 1, alpha_curve_);
}

Hash Image::content() const {
    const auto& [wide, high, channels, numbers, curve, alpha_curve] = *this;  // all of them
    Hasher hasher;
    const std::array<std::uint64_t, 4> shape{wide, high, channels, numbers.index()};
    hasher.add(std::as_bytes(std::span(shape)));
    std::visit([&](const auto& values) { hasher.add(std::as_bytes(std::span(values))); }, numbers);
    for (const auto& one : {curve, alpha_curve}) {
        const std::uint64_t size = one ? one->size() : 0;
        hasher.add(std::as_bytes(std::span(&size, 1)));
        if (one) hasher.add(std::as_bytes(std::span(*one)));
    }
    return hasher.finish();
}

std::size_t Image::memory() const {
    return std::visit([](const auto& numbers) { return numbers.size() * sizeof(numbers[0]); }, numbers_);
}

}  // namespace lightnet
