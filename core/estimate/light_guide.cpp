#include "core/estimate/light_guide.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr std::size_t most_in_leaf = 1000;  // records, of a part of space that is not cut
constexpr int most_cuts = 32;               // of space, one after the other
constexpr double records_of_parent = 512;   // as if so many had been found as in all of the larger part
constexpr double guide_even_share = 0.1;    // of all directions, for what records overlooked

using Records = std::span<GuideRecord>;

/// What records of a part of the surfaces tell.
struct Found {
    std::vector<double> light = std::vector<double>(GuideSquare::cells);  // in each cell of the square
    double all = 0, squares = 0, count = 0;

    // To the four cells around the place, by how near they are.
    void add(const GuideRecord& record) {
        const double weight = record.light();
        const Vec2 place = record.place();
        const auto [left, right, to_right] = neighbours(place.x);
        const auto [low, high, to_high] = neighbours(place.y);
        light[left + low / GuideSquare::side] += weight * (1 - to_right) * (1 - to_high);
        light[right + low / GuideSquare::side] += weight * to_right * (1 - to_high);
        light[left + high / GuideSquare::side] += weight * (1 - to_right) * to_high;
        light[right + high / GuideSquare::side] += weight * to_right * to_high;
        all += weight, squares += weight * weight, count += 1;
    }
    void add(const Found& other) {
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += other.light[i];
        all += other.all, squares += other.squares, count += other.count;
    }
    /// So many records of equal light would tell as much.
    double equal_records() const { return squares > 0 ? all * all / squares : 0; }

private:
    struct Neighbours {
        std::size_t before, after;
        double to_after;
    };
    // Of middles of columns.
    static Neighbours neighbours(float at) {
        constexpr std::size_t side = GuideSquare::side;
        const float shifted = std::fmax(at * float(side) - 0.5f, 0.0f);
        const auto before = std::size_t(shifted);
        return {before * side, std::min(before + 1, side - 1) * side, double(shifted - float(before))};
    }
};

/// Of each part: what its records tell, and as far as they are few, what is found in the larger part that it is of.
std::vector<double> shape_of(const Found& found, const std::vector<double>& larger) {
    const double count = found.equal_records(), known = count / (count + records_of_parent);
    std::vector<double> shape(larger.size());
    for (std::size_t i = 0; i < shape.size(); ++i)
        shape[i] = (found.all > 0 ? known * found.light[i] / found.all : 0) + (1 - known) * larger[i];
    return shape;
}
GuideCell made_cell(const Found& found, const std::vector<double>& shape) {
    std::vector<double> parts(shape);
    for (double& part : parts) part = (1 - guide_even_share) * part + guide_even_share / double(GuideSquare::cells);
    return {GuideSquare(parts), float(found.all / found.count)};
}

/// Cuts records up, and what it cuts is in order: each part lies side by side.
class Cutter {
public:
    /// False: there are too few, or they all lie at one place.
    bool cut(Records records, int cuts) {
        if (records.size() <= most_in_leaf || cuts >= most_cuts || !find_middle(records)) return false;
        const std::size_t count = part(records);
        below = records.first(count), above = records.subspan(count);
        return true;
    }
    std::uint32_t axis = 0;
    float border = 0;
    Records below, above;

private:
    // Along the longest side, as some of them tell.
    bool find_middle(Records records) {
        const std::size_t step = (records.size() + looked_at - 1) / looked_at;
        Box box;
        for (std::size_t i = 0; i < records.size(); i += step) box.add(records[i].position());
        axis = static_cast<std::uint32_t>(box.longest_axis());
        places_.clear();
        for (std::size_t i = 0; i < records.size(); i += step) places_.push_back(records[i].position()[axis]);
        const auto half = places_.begin() + std::ptrdiff_t(places_.size() / 2);
        std::nth_element(places_.begin(), half, places_.end());
        border = *half;
        return box.low[axis] < border;
    }

    // Without a branch, as on which side one lies can't be foretold. In the order in which they were.
    std::size_t part(Records records) {
        if (above_.size() < records.size()) above_.resize(records.size());
        std::size_t count = 0, count_above = 0;
        for (const GuideRecord record : records) {
            const bool is_below = record.position()[axis] < border;
            records[count] = record, above_[count_above] = record;
            count += is_below, count_above += !is_below;
        }
        std::copy_n(above_.begin(), count_above, records.begin() + std::ptrdiff_t(count));
        return count;
    }

    static constexpr std::size_t looked_at = 512;
    std::vector<float> places_;
    std::vector<GuideRecord> above_;
};

/// Those that a guide learns from, turn by turn, each in the order in which they came.
struct ByTurn {
    explicit ByTurn(std::span<const std::span<const GuideRecord>> lots) {
        std::array<std::size_t, LightGuide::turns> next{};
        for (const auto& lot : lots)
            for (const auto& record : lot)
                if (LightGuide::learns_from(record)) ++counts[record.turn()];
        std::size_t count = 0;
        for (std::size_t turn = 0; turn < counts.size(); ++turn) next[turn] = count, count += counts[turn];
        records.resize(count);
        for (const auto& lot : lots)
            for (const auto& record : lot)
                if (LightGuide::learns_from(record)) records[next[record.turn()]++] = record;
    }
    std::array<std::size_t, LightGuide::turns> counts{};
    std::vector<GuideRecord> records;
};

}  // namespace

LightGuide::LightGuide(std::span<const std::span<const GuideRecord>> lots, Builders& builders) : LightGuide() {
    ByTurn sorted(lots);
    struct Next {
        std::uint32_t branch;
        Records records;
        int cuts;
    };
    std::vector<Next> next;
    Records rest = sorted.records;
    for (std::uint32_t turn = 0; turn < turns; ++turn) {
        const std::size_t count = sorted.counts[turn];
        if (count == 0) continue;
        roots_[turn] = static_cast<std::uint32_t>(branches_.size());
        next.push_back({roots_[turn], rest.first(count), 0});
        rest = rest.subspan(count);
        branches_.emplace_back();
    }
    std::vector<Records> leaves;
    Cutter cutter;
    for (std::size_t i = 0; i < next.size(); ++i) {
        const auto [branch, some, cuts] = next[i];
        most_cuts_ = std::max(most_cuts_, cuts);
        if (!cutter.cut(some, cuts)) {
            branches_[branch].next = branch;
            branches_[branch].cell = static_cast<std::uint32_t>(leaves.size());
            leaves.push_back(some);
            continue;
        }
        const auto pair = static_cast<std::uint32_t>(branches_.size());
        branches_[branch] = {cutter.border, cutter.axis, pair, nothing};
        branches_.resize(branches_.size() + 2);
        next.push_back({pair, cutter.below, cuts + 1});
        next.push_back({pair + 1, cutter.above, cuts + 1});
    }
    learn(leaves, builders);
}

void LightGuide::learn(std::span<const std::span<GuideRecord>> leaves, Builders& builders) {
    std::vector<Found> of_leaves(leaves.size());
    builders.each(leaves.size(), [&](std::size_t i) {
        for (const auto& record : leaves[i]) of_leaves[i].add(record);
    });
    std::vector<Found> found(branches_.size());
    std::vector<std::vector<double>> shapes(branches_.size());
    for (std::size_t i = branches_.size(); i-- > 1;) {
        const Branch& branch = branches_[i];
        if (branch.cell != nothing)
            found[i] = std::move(of_leaves[branch.cell]);
        else
            found[i].add(found[branch.next]), found[i].add(found[branch.next + 1]);
    }
    const std::vector<double> even(GuideSquare::cells, 1 / double(GuideSquare::cells));
    cells_.resize(leaves.size());
    for (std::size_t i = 1; i < branches_.size(); ++i) {
        const Branch& branch = branches_[i];
        if (shapes[i].empty()) shapes[i] = shape_of(found[i], even);
        if (branch.cell != nothing) {
            cells_[branch.cell] = made_cell(found[i], shapes[i]);
            continue;
        }
        for (const std::uint32_t part : {branch.next, branch.next + 1}) shapes[part] = shape_of(found[part], shapes[i]);
    }
}

void LightGuide::find(const Columns3& positions, const Flags& sides, std::size_t count,
                      std::array<const GuideCell*, lanes>& cells) const {
    std::array<std::uint32_t, lanes> at;
    for (std::size_t i = 0; i < count; ++i) at[i] = roots_[sides[i]];
    const std::array<const float*, 3> columns{positions.x.data(), positions.y.data(), positions.z.data()};
    for (int cut = 0; cut < most_cuts_; ++cut)
        for (std::size_t i = 0; i < count; ++i) {
            const Branch& branch = branches_[at[i]];
            at[i] = branch.next + (columns[branch.axis][i] >= branch.border);
        }
    for (std::size_t i = 0; i < count; ++i) cells[i] = cell_at(at[i]);
}

}  // namespace lightnet
