#include "core/readers/daylight/sun_position.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace lightnet {
namespace {

constexpr double whole_turn = 2 * std::numbers::pi, to_radians = std::numbers::pi / 180;

/// From noon of 1 January 2000, universal time, to midnight before that day of the Gregorian calendar.
double days_from_2000(int year, int month, int day) {
    const std::int64_t y = year - (month <= 2 ? 1 : 0), m = month + (month <= 2 ? 9 : -3);  // March is the first month
    const std::int64_t leaps = y / 4 - y / 100 + y / 400;
    const std::int64_t days = 365 * y + leaps + (153 * m + 2) / 5 + day - 1;  // from 1 March of the year 0
    return double(days) - 730425 - 0.5;
}

}  // namespace

SunPosition sun_position(const TimeAndPlace& at) {
    const double hours = at.hour - at.timezone + (at.minute + at.second / 60) / 60;  // universal time
    const double days = days_from_2000(at.year, at.month, at.day) + hours / 24;

    // On the ecliptic
    const double omega = 2.1429 - 0.0010394594 * days;
    const double mean_longitude = 4.8950630 + 0.017202791698 * days;
    const double anomaly = 6.2400600 + 0.0172019699 * days;
    const double longitude = mean_longitude + 0.03341607 * std::sin(anomaly) + 0.00034894 * std::sin(2 * anomaly) -
                             0.0001134 - 0.0000203 * std::sin(omega);
    const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(omega);

    // On the sphere of the sky
    const double ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
    const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));

    // As it is seen from that place
    const double greenwich = 6.6974243242 + 0.0657098283 * days + hours;  // sidereal time, hours
    const double angle = (greenwich * 15 + at.longitude) * to_radians - ascension;
    const double latitude = at.latitude * to_radians;
    const double upwards =
        std::cos(latitude) * std::cos(angle) * std::cos(declination) + std::sin(declination) * std::sin(latitude);
    const double from_zenith = std::acos(std::clamp(upwards, -1.0, 1.0));
    const double azimuth =
        std::atan2(-std::sin(angle), std::tan(declination) * std::cos(latitude) - std::sin(latitude) * std::cos(angle));
    constexpr double parallax = 6371.01 / 149597890;  // the earth's radius over its distance from the sun
    return {from_zenith + parallax * std::sin(from_zenith), azimuth < 0 ? azimuth + whole_turn : azimuth};
}

}  // namespace lightnet
