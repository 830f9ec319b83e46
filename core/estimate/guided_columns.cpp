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

void GuidedColumns::find(const LightGuide& guide, const LambertianSurfaces& surfaces) {
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
    for (std::size_t i = 0; i < count_; ++i) known_[i] = cells_[i] != nullptr;
}

// As GuidedPoint::warped().
struct GuidedColumns::Warping {
    GuidedColumns& all;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < all.count_; ++i) {
            const Vec2 u = all.numbers_[i];
            const SquarePoint at = GuideSquare::warped(u, all.column_of_[i], all.cell_of_[i]);
            const bool known = all.known_[i] != 0;
            all.warped_.set(i, {known ? at.place.x : u.x, known ? at.place.y : u.y});
            all.favour_[i] = known ? at.density : 1;
        }
    }
};

void GuidedColumns::warp(LambertianSurfaces& surfaces) {
    static const GuideSquare even;
    for (std::size_t i = 0; i < count_; ++i) {
        const GuideSquare& square = cells_[i] ? cells_[i]->square : even;
        const Vec2 u = surfaces.numbers(i);
        const GuideSquare::Part column = square.column_at(u.x);
        numbers_.set(i, u);
        column_of_.set(i, column);
        cell_of_.set(i, square.cell_at(column.index, u.y));
    }
    Warping warping{*this};
    work_in_lanes(warping);
    for (std::size_t i = 0; i < count_; ++i) surfaces.set_numbers(i, warped_[i]);
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
struct GuidedColumns::Shares {
    GuidedColumns& all;
    Heuristic heuristic;

    [[gnu::always_inline]] void work() {
        const Heuristic by = heuristic;
        for (std::size_t i = 0; i < all.count_; ++i) {
            const float height = all.height_[i], found = all.density_[i] * height * inverse_pi;
            const float guided = height > 0 ? found : 0;
            const float pdf = all.known_[i] != 0 ? guided : all.pdf_[i];
            const float part = lightnet::share(squares(by, all.from_infinity_[i] != 0), all.lamp_pdf_[i], pdf);
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
    Places places{*this};
    work_in_lanes(places);
    for (std::size_t i = 0; i < count_; ++i)
        density_[i] = cells_[i] && height_[i] > 0 ? cells_[i]->square.density(place_[i]) : 0;
    Shares shares{*this, heuristic};
    work_in_lanes(shares);
}

}  // namespace lightnet
