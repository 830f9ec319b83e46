#include "core/estimate/guided_columns.hpp"

namespace lightnet {

// As GuideSide::of() and LightGuide::turn_of().
struct GuidedColumns::Sides {
    GuidedColumns& all;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < all.count_; ++i) {
            const GuideSide side = GuideSide::of(all.normal_[i], all.shading_[i], all.outgoing_[i]);
            all.up_.set(i, side.up);
            all.turned_[i] = side.turned;
            all.turn_[i] = LightGuide::turn_of(side);
        }
    }
};

void GuidedColumns::find_cells(const LightGuide& guide, const MeshPoints& surfaces) {
    count_ = surfaces.size();
    for (std::size_t i = 0; i < count_; ++i) {
        position_.set(i, surfaces.position(i));
        normal_.set(i, surfaces.normal(i));
        shading_.set(i, surfaces.shading(i));
        outgoing_.set(i, surfaces.outgoing(i));
    }
    Sides sides{*this};
    work_in_lanes(sides);
    guide.find(position_, turn_, count_, cells_);
    for (std::size_t i = 0; i < count_; ++i) {
        known_[i] = cells_[i] != nullptr;
        if (cells_[i]) __builtin_prefetch(cells_[i]);
    }
}

// As GuidedPoint::warped().
struct GuidedColumns::Warping {
    GuidedColumns& all;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < all.count_; ++i) {
            const Vec2 u = all.numbers_[i];
            const SquarePoint at = GuideSquare::warped(u, all.column_of_[i], all.cell_of_[i]);
            const bool leads = all.leads_[i] != 0, moves = leads & (all.alone_[i] == 0);
            all.warped_.set(i, {moves ? at.place.x : u.x, moves ? at.place.y : u.y});
            all.favour_[i] = leads ? at.density : 1;
        }
    }
};

void GuidedColumns::warp_numbers(MeshPoints& surfaces) {
    static const GuideSquare even;
    for (std::size_t i = 0; i < count_; ++i) {
        const GuideSquare& square = cells_[i] ? cells_[i]->square : even;
        const Vec2 u = surfaces.numbers(i);
        const GuideSquare::Part column = square.column_at(u.x);
        numbers_.set(i, u);
        column_of_.set(i, column);
        __builtin_prefetch(square.cells_of(column.index));
    }
    for (std::size_t i = 0; i < count_; ++i) {
        const GuideSquare& square = cells_[i] ? cells_[i]->square : even;
        cell_of_.set(i, square.cell_at(column_of_[i].index, numbers_[i].y));
    }
    Warping warping{*this};
    work_in_lanes(warping);
    for (std::size_t i = 0; i < count_; ++i) {
        if (leads_[i] & alone_[i]) favour_[i] = cells_[i]->square.density(surfaces.numbers(i));
        surfaces.set_numbers(i, warped_[i]);
    }
}

// As GuidedPoint::height() and place().
struct GuidedColumns::Places {
    GuidedColumns& all;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < all.count_; ++i) {
            const Vec3 direction = all.direction_[i];
            const Frame frame = Frame::around(all.up_[i]);
            const float z = dot(direction, frame.z);
            all.height_[i] = all.turned_[i] != 0 ? -z : z;
            all.place_.set(i, from_disk({dot(direction, frame.x), dot(direction, frame.y)}));
        }
    }
};

// As GuidedPoint::pdf().
struct GuidedColumns::Densities {
    GuidedColumns& all;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < all.count_; ++i) {
            const float pdf = all.pdf_[i], height = all.height_[i];
            const float led = guided_pdf(pdf, all.chance_[i], height, all.density_[i]);
            const bool leads = (all.known_[i] != 0) & (all.chance_[i] > 0) & (pdf > 0) & (height > 0);
            all.guided_pdf_[i] = leads ? led : pdf;
        }
    }
};

/// Of the directions whose density is pdf_ by surfaces alone.
void GuidedColumns::find_densities() {
    Places places{*this};
    work_in_lanes(places);
    for (std::size_t i = 0; i < count_; ++i)
        density_[i] = cells_[i] && height_[i] > 0 ? cells_[i]->square.density(place_[i]) : 0;
    Densities densities{*this};
    work_in_lanes(densities);
}

void GuidedColumns::find_favours(const Columns3& directions, const Column& pdf, const Flags& found) {
    direction_ = directions;
    pdf_ = pdf;
    find_densities();
    for (std::size_t i = 0; i < count_; ++i) favour_[i] = found[i] ? guided_pdf_[i] / pdf_[i] : 1;
}

struct GuidedColumns::Shares {
    GuidedColumns& all;
    Heuristic heuristic;

    [[gnu::always_inline]] void work() {
        const Heuristic by = heuristic;
        for (std::size_t i = 0; i < all.count_; ++i) {
            const bool squared = squares(by, all.from_infinity_[i] != 0);
            const float part = lightnet::share(squared, all.lamp_pdf_[i], all.guided_pdf_[i]);
            all.shares_[i] = all.bare_[i] != 0 ? 1 : part;
        }
    }
};

void GuidedColumns::share(const RaysToLamp& rays, Heuristic heuristic) {
    direction_ = rays.direction;
    lamp_pdf_ = rays.lamp_pdf;
    pdf_ = rays.pdf;
    bare_ = rays.bare;
    from_infinity_ = rays.from_infinity;
    find_densities();
    Shares shares{*this, heuristic};
    work_in_lanes(shares);
}

}  // namespace lightnet
