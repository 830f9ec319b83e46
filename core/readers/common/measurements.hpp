// Measured materials in RGL's files (.bsdf), as pbrt-v4 and Mitsuba 3 name them: Dupuy & Jakob 2018, "An Adaptive
// Parameterization for Efficient Material Acquisition and Rendering".
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "core/base/bytes.hpp"
#include "core/readers/common/report.hpp"
#include "core/scene/bsdf/measurement.hpp"

namespace lightnet {

/// What such a file says: with `spectra` (nanometres, seen as the colours of surfaces are) or with `rgb`. Throws Error,
/// without a file name, where it is not sound.
std::shared_ptr<const Measurement> read_measurement(std::span<const std::byte> bytes);

/// Those of one scene, each file read once. One thread.
class Measurements {
public:
    explicit Measurements(Report& report) : report_(report) {}

    /// That of the file at `path`, whose bytes `read` gives. Null: it can't be had, and a warning says so.
    std::shared_ptr<const Measurement> get(const std::string& path, const SourceLine& where,
                                           const std::function<Bytes()>& read);

private:
    struct Known {
        std::shared_ptr<const Measurement> measured;
        std::string problem;
    };
    Report& report_;
    std::map<std::string, Known> known_;
};

}  // namespace lightnet
