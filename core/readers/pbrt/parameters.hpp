// The parameter list of a pbrt statement: "float fov" [37.5] and its like.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/math/vec.hpp"
#include "core/readers/common/report.hpp"
#include "core/readers/pbrt/colour_space.hpp"

namespace lightnet::pbrt {

enum class Type {
    number,  // "float"
    integer,
    point2,
    vector2,
    point3,
    vector3,
    normal,
    rgb,
    spectrum,   // texts: a name or a file; numbers: wavelength and value in turn
    blackbody,  // kelvin
    boolean,
    text,     // "string"
    texture,  // texts: its name
};

/// As a pbrt file spells it.
std::string_view name_of(Type type);
/// The reverse; older spellings ("point", "color") included.
std::optional<Type> type_named(std::string_view word);
/// How many numbers make one value: 3 for a point3.
std::size_t width_of(Type type);
const std::vector<std::string>& type_names();

struct Parameter {
    Type type = Type::number;
    std::string name;
    SourceLine where;
    std::vector<float> numbers;  // of number, points, vectors, normals, rgb, spectrum, blackbody
    std::vector<std::int32_t> integers;
    std::vector<std::string> texts;
    std::vector<std::string> paths;  // the texts, read as names of files
    std::vector<bool> booleans;
    ColourSpace space = ColourSpace::srgb;  // of rgb
    bool xyz = false;                       // it was given so
};

/// The parameters of one statement, asked for by name and type. A wrong type is reported where it stands, and the
/// fallback taken; what nobody asked for can be reported in the end. The report must outlive it.
class Parameters {
public:
    Parameters(std::string owner, SourceLine where, Report& report);

    void add(Parameter parameter);
    /// Values for names that the statement itself doesn't give (pbrt's Attribute statement).
    void inherit(const std::vector<std::shared_ptr<const Parameter>>& defaults);
    const std::vector<std::shared_ptr<const Parameter>>& all() const { return parameters_; }

    /// The parameter of that name, whatever its type.
    const Parameter* find(std::string_view name);
    /// The parameter of that name, if its type is `type`. Another type is an error.
    const Parameter* find(std::string_view name, Type type);

    float number(std::string_view name, float fallback);
    std::optional<float> maybe_number(std::string_view name);
    int integer(std::string_view name, int fallback);
    bool boolean(std::string_view name, bool fallback);
    std::string text(std::string_view name, const std::string& fallback);
    /// The name of a file; "": there is none.
    std::string file(std::string_view name);
    std::vector<Vec3> triples(std::string_view name, Type type);
    /// As in pbrt-v3, they may be plain numbers, too.
    std::vector<Vec2> pairs(std::string_view name, Type type);
    /// The rgb that the statement itself gives are of that space.
    void set_colour_space(ColourSpace space);
    /// As in pbrt-v3, a parameter of another type than is asked for is none, and named.
    void be_lenient() { lenient_ = true; }
    bool lenient() const { return lenient_; }
    /// Says that a parameter's type makes it none.
    void warn_type(const Parameter& parameter, std::string_view wanted) const;
    /// Nobody looks at the rest of this statement.
    void ignore_all();
    /// Names that may stand there without any effect on what is read here.
    void ignore(std::initializer_list<std::string_view> names);

    /// Warns of each parameter that was not asked for.
    void warn_unused() const;
    void error(const std::string& what) const;
    void warn(const std::string& what) const;
    const SourceLine& where() const { return where_; }
    /// "Shape 'sphere'"
    const std::string& owner() const { return owner_; }
    Report& report() const { return *report_; }

private:
    template <class Value>
    const Value* single(std::string_view name, Type type, const std::vector<Value> Parameter::*values);

    std::string owner_;
    SourceLine where_;
    Report* report_;
    std::vector<std::shared_ptr<const Parameter>> parameters_;
    bool lenient_ = false;
    std::size_t own_ = 0;  // the first so many are the statement's own
    std::set<std::string, std::less<>> asked_;
};

}  // namespace lightnet::pbrt
