#include "core/network/light/sectors.hpp"

#include <algorithm>
#include <span>

#include "core/base/math/box.hpp"

namespace lightnet {
namespace {

std::size_t longest_axis(std::span<const Vec3> points) {
    Box box;
    for (const Vec3 point : points) box.add(point);
    return box.longest_axis();
}

}  // namespace

Sectors::Sectors(std::vector<Vec3> landmarks, std::uint32_t count) : count_(count) {
    std::erase_if(landmarks, [](Vec3 point) { return !finite(point); });
    root_ = cut(landmarks, {0, landmarks.size()}, 0, count);
}

// Cuts so that both sides have landmarks in proportion to the sectors that they will become.
// DECISIONS: sectors-by-landmarks
std::int32_t Sectors::cut(std::vector<Vec3>& landmarks, Range range, std::uint32_t first, std::uint32_t count) {
    if (count <= 1) return -1 - static_cast<std::int32_t>(first);
    const std::uint32_t below = count / 2;
    const std::size_t axis = longest_axis(std::span(landmarks).subspan(range.first, range.end - range.first));
    const std::size_t middle = range.first + (range.end - range.first) * below / count;
    const auto at = [&](std::size_t i) { return landmarks.begin() + static_cast<std::ptrdiff_t>(i); };
    if (range.first < range.end)
        std::nth_element(at(range.first), at(middle), at(range.end),
                         [axis](Vec3 a, Vec3 b) { return a[axis] < b[axis]; });
    const float border = range.first < range.end ? landmarks[middle][axis] : 0;
    const std::size_t index = borders_.size();
    borders_.push_back({axis, border, 0, 0});
    const auto low = cut(landmarks, {range.first, middle}, first, below);
    const auto high = cut(landmarks, {middle, range.end}, first + below, count - below);
    borders_[index].below = low;
    borders_[index].above = high;
    return static_cast<std::int32_t>(index);
}

}  // namespace lightnet
