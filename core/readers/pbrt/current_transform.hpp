// The transform that holds for pbrt's next statement, and how it moves.
#pragma once

#include <map>
#include <string>

#include "core/base/math/transform.hpp"
#include "core/readers/common/report.hpp"
#include "core/readers/pbrt/syntax.hpp"

namespace lightnet::pbrt {

/// pbrt's current transformation matrices: to the world from what a statement makes, at both ends of TransformTimes.
struct MovingTransform {
    Matrix at_start, at_end;
    bool moves() const { return !(at_start == at_end); }
};

/// A transform, and which of its ends statements change (ActiveTransform).
struct TransformState {
    MovingTransform transform;
    bool start_active = true, end_active = true;
};

/// Executes LookAt, Translate, Scale, Rotate, Transform, ConcatTransform, Identity, CoordinateSystem,
/// CoordSysTransform, ActiveTransform and TransformTimes on a state that the Builder saves and restores.
class CurrentTransform {
public:
    explicit CurrentTransform(Report& report) : report_(report) {}
    static bool knows(const std::string& directive);
    void execute(const Statement& statement, TransformState& state);

    /// All begins anew, in world space.
    void begin_world(TransformState& state);
    /// A coordinate system by that name.
    void define(const std::string& name, const MovingTransform& transform) { systems_[name] = transform; }
    /// As it stands after so many seconds, see between().
    Matrix at(const MovingTransform& transform, double seconds) const;
    double end_seconds() const { return end_; }

private:
    void apply(const Matrix& matrix, TransformState& state);
    void replace(const MovingTransform& transform, TransformState& state);
    void coord_sys_transform(const Statement& statement, TransformState& state);
    void active_transform(const Statement& statement, TransformState& state);
    void transform_times(const Statement& statement);

    Report& report_;
    std::map<std::string, MovingTransform> systems_;
    double start_ = 0, end_ = 1;  // TransformTimes
};

}  // namespace lightnet::pbrt
