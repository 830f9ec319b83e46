// An image in memory, for textures and environments.
#pragma once

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "core/base/hash.hpp"
#include "core/base/math/rgb.hpp"

namespace lightnet {

/// A decoded image, row 0 on top. It keeps the numbers of its file as they are, with as few bits; what is looked up
/// is linear.
class Image {
public:
    std::uint32_t width = 0, height = 0;

    Image() = default;
    /// Linear colours; `alpha` is empty where all is opaque.
    Image(std::uint32_t wide, std::uint32_t high, const std::vector<Rgb>& pixels, const std::vector<float>& alpha = {});
    /// Numbers of 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGB, alpha) channels, pixel by pixel. `curve` says how much
    /// light each of the 256 or 65536 numbers stands for; `alpha_curve` the same of alpha.
    using Curve = std::shared_ptr<const std::vector<float>>;
    struct Coded {
        std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>> numbers;
        std::uint32_t channels = 3;
        Curve curve, alpha_curve;
    };
    Image(std::uint32_t wide, std::uint32_t high, Coded coded);

    bool empty() const { return width == 0 || height == 0; }
    /// Does it keep whole numbers, which its curve makes light of?
    bool coded() const { return curve_ != nullptr; }
    bool has_alpha() const { return channels_ == 2 || channels_ == 4; }
    /// The colour of a pixel that is there.
    Rgb colour(std::uint32_t x, std::uint32_t y) const;
    /// Those of four pixels that are there: of two rows, above and below, those of two columns, left and right.
    struct Square {
        Rgb upper_left, upper_right, lower_left, lower_right;
        /// The weighted mean: `dx` of the right, `dy` of what is below.
        Rgb bilinear(float dx, float dy) const {
            return (upper_left * (1 - dx) + upper_right * dx) * (1 - dy) +
                   (lower_left * (1 - dx) + lower_right * dx) * dy;
        }
    };
    Square square(std::uint32_t left, std::uint32_t right, std::uint32_t above, std::uint32_t below) const;
    /// All pixels' linear red, green and blue, row by row, if it keeps just these; else null.
    const float* linear_rgb() const;
    /// Where its first number lies in memory.
    const void* where(std::uint32_t x, std::uint32_t y) const;
    /// A pixel that will soon be asked for.
    void expect(std::uint32_t x, std::uint32_t y) const;
    /// How opaque that pixel is: 1 where nothing else is said.
    float alpha(std::uint32_t x, std::uint32_t y) const;
    /// Names what it shows. Another file, or another way to keep the same colours, may be another image.
    Hash content() const;
    /// Bytes of its numbers.
    std::size_t memory() const;

private:
    float number(std::size_t at, const Curve& curve) const;

    std::uint32_t channels_ = 3;
    std::variant<std::vector<float>, std::vector<std::uint8_t>, std::vector<std::uint16_t>> numbers_;
    Curve curve_, alpha_curve_;  // not of floats
};

}  // namespace lightnet
