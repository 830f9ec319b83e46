// A lighting operator: plain algorithm code that answers questions about light.
#pragma once

#include <span>

#include "core/base/math/rgb.hpp"
#include "core/base/query.hpp"
#include "core/network/light/frozen.hpp"

namespace lightnet {

class Services;

/// Answers questions about light, by itself or by asking its inputs. Asking blocks, in the ordinary sense of the word.
/// While one call waits, another may enter the same operator, so light() is const and members are no place for scratch
/// data. It is never called from two threads at once. An answer depends on its question and on what was there before
/// the first one, never on the other questions of the call or on earlier calls.
class LightOp {
public:
    virtual ~LightOp() = default;

    /// What the operator learns before the first question: see Services. Called once, when all inputs are prepared, and
    /// only if its kind says that it prepares. Questions may come while it waits in here, but only those of rehearsals.
    virtual void prepare(Services&) {}

    /// What it has learnt, constant from the end of prepare() on, for nodes of this place that take it. Its kind says
    /// what it is.
    virtual Frozen frozen() const { return {}; }

    /// Writes, for each question, the radiance (W·sr⁻¹·m⁻²) leaving the point in its direction. `answers` comes
    /// zeroed and holds one colour per question; an operator that adds up its inputs has one colour per layer and
    /// question, and passes them on with add().
    virtual void light(std::span<const Query> questions, std::span<Rgb> answers) const = 0;

protected:
    LightOp() = default;
    LightOp(const LightOp&) = delete;
    LightOp& operator=(const LightOp&) = delete;
};

}  // namespace lightnet
