// Rays that can't be traced.
#pragma once

namespace lightnet {

/// Is told of each ray of a thread that is not finite, has no direction, or begins farther away than can be traced. It
/// meets nothing.
class LostRays {
public:
    virtual ~LostRays() = default;
    virtual void lost() = 0;
};

/// Who is told of those of the calling thread from now on; null: nobody. Returns who was told before.
LostRays* tell_of_lost_rays(LostRays* told);

/// Until the end of a block.
class TellingOfLostRays {
public:
    explicit TellingOfLostRays(LostRays& told) : before_(tell_of_lost_rays(&told)) {}
    ~TellingOfLostRays() { tell_of_lost_rays(before_); }
    TellingOfLostRays(const TellingOfLostRays&) = delete;
    TellingOfLostRays& operator=(const TellingOfLostRays&) = delete;

private:
    LostRays* before_;
};

}  // namespace lightnet
