#include "core/estimate/light_guide.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr std::size_t most_in_leaf = 4000;  // records, of a part of space that is not cut
constexpr int most_cuts = 32;               // of space, one after the other
constexpr double even_records = 16;         // as if so many had been found evenly
constexpr double guide_even_share = 0.3;    // of all directions, for what records overlooked
constexpr float glossy_share = 0.25f;       // of directions that go by the guide where a surface is not even
constexpr double neighbours_share = 0.25;   // of a cell of the square: what its neighbours found

using Records = std::span<GuideRecord>;

// What each cell of the square has, and what its neighbours have.
std::vector<double> blurred(const std::vector<double>& light) {
    constexpr std::size_t side = GuideSquare::side;
    std::vector<double> spread(light.size());
    for (std::size_t x = 0; x < side; ++x)
        for (std::size_t y = 0; y < side; ++y) {
            const auto at = [&](std::size_t i, std::size_t j) { return light[i * side + j]; };
            const std::size_t left = x > 0 ? x - 1 : x, right = x + 1 < side ? x + 1 : x;
            const std::size_t low = y > 0 ? y - 1 : y, high = y + 1 < side ? y + 1 : y;
            const double others = at(left, y) + at(right, y) + at(x, low) + at(x, high);
            spread[x * side + y] = (1 - neighbours_share) * at(x, y) + neighbours_share / 4 * others;
        }
    return spread;
}

GuideCell made_cell(Records records) {
    std::vector<double> light(GuideSquare::cells);
    double all = 0, squares = 0;
    for (const auto& record : records) {
        const double weight = double{record.radiance} / record.density;
        light[GuideSquare::cell_of(record.at())] += weight;
        all += weight;
        squares += weight * weight;
    }
    auto parts = blurred(light);
    double total = 0;
    for (const double part : parts) total += part;
    const double count = squares > 0 ? all * all / squares : 0;  // so many equal records would tell as much
    const double known = total > 0 ? (1 - guide_even_share) * count / (count + even_records) : 0;
    for (double& part : parts) part = (total > 0 ? known * part / total : 0) + (1 - known) / double(GuideSquare::cells);
    return {GuideSquare(parts), glossy_share, float(all / double(records.size()))};
}

// At the middle record along the longest side. False: they all lie at one place.
bool middle(Records records, std::uint32_t& axis, float& border) {
    Box box;
    for (const auto& record : records) box.add(record.position);
    axis = static_cast<std::uint32_t>(box.longest_axis());
    std::vector<float> places;
    places.reserve(records.size());
    for (const auto& record : records) places.push_back(record.position[axis]);
    const auto half = places.begin() + std::ptrdiff_t(places.size() / 2);
    std::nth_element(places.begin(), half, places.end());
    border = *half;
    return box.low[axis] < border;
}

}  // namespace

LightGuide::LightGuide(std::span<const GuideRecord> records, Builders& builders) {
    std::array<std::vector<GuideRecord>, turns> by_turn;
    for (const auto& record : records)
        if (learns_from(record)) by_turn[record.turn].push_back(record);
    struct Next {
        std::uint32_t branch;
        Records records;
        int cuts;
    };
    std::vector<Next> next;
    roots_.fill(nothing);
    for (std::uint32_t turn = 0; turn < turns; ++turn) {
        if (by_turn[turn].empty()) continue;
        roots_[turn] = static_cast<std::uint32_t>(branches_.size());
        next.push_back({roots_[turn], by_turn[turn], 0});
        branches_.emplace_back();
    }
    std::vector<Records> leaves;
    for (std::size_t i = 0; i < next.size(); ++i) {
        const auto [branch, some, cuts] = next[i];
        std::uint32_t axis = 3;
        float border = 0;
        if (some.size() <= most_in_leaf || cuts >= most_cuts || !middle(some, axis, border)) {
            branches_[branch] = {0, 3, static_cast<std::uint32_t>(leaves.size())};
            leaves.push_back(some);
            continue;
        }
        const auto below = std::stable_partition(
            some.begin(), some.end(), [&, a = axis, b = border](const auto& r) { return r.position[a] < b; });
        const auto count = std::size_t(below - some.begin());
        const auto pair = static_cast<std::uint32_t>(branches_.size());
        branches_[branch] = {border, axis, pair};
        branches_.resize(branches_.size() + 2);
        next.push_back({pair, some.first(count), cuts + 1});
        next.push_back({pair + 1, some.subspan(count), cuts + 1});
    }
    cells_.resize(leaves.size());
    builders.each(leaves.size(), [&](std::size_t i) { cells_[i] = made_cell(leaves[i]); });
}

}  // namespace lightnet
