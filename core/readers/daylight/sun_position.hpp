// The position of the sun at a time and place.
#pragma once

namespace lightnet {

struct TimeAndPlace {
    int year = 2010, month = 7, day = 10;
    double hour = 15, minute = 0, second = 0;                       // local time
    double latitude = 35.6894, longitude = 139.6917, timezone = 9;  // degrees north, degrees east, hours
};

struct SunPosition {
    double from_zenith = 0, azimuth = 0;  // radians; the latter from north by way of east
};

/// Blanco-Muriel et al. 2001, "Computing the Solar Vector": within half a minute of arc from 1999 to 2015, and not far
/// from that in other years.
SunPosition sun_position(const TimeAndPlace& at);

}  // namespace lightnet
