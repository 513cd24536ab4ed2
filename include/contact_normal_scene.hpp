// contact_normal.hpp: what is simulated.
#ifndef CONTACT_NORMAL_SCENE_HPP
#define CONTACT_NORMAL_SCENE_HPP

#include <contact_normal_adhesion.hpp>
#include <contact_normal_arrays.hpp>
#include <contact_normal_friction.hpp>
#include <contact_normal_visco.hpp>

#include <array>
#include <memory>
#include <optional>
#include <utility>

namespace contact_normal {

/// What is simulated. Members of the same name as those of `contact_normal_scene`; each returns the scene. Arrays are not copied: they
/// must live until the last solve of the scene or of a copy of it is over. A scene needs an approach or a force.
class scene {
public:
    scene(const grid &of, const body &both) : scene(of, both, both) {}
    scene(const grid &of, const body &one, const body &other)
    {
        contact_normal_scene_init(&scene_);
        scene_.mx = of.mx, scene_.my = of.my, scene_.dx = of.dx, scene_.dy = of.dy;
        scene_.shear_modulus[0] = one.shear_modulus, scene_.shear_modulus[1] = other.shear_modulus;
        scene_.poisson_ratio[0] = one.poisson_ratio, scene_.poisson_ratio[1] = other.poisson_ratio;
    }

    /// h, my * mx values, x fastest.
    scene &undeformed_distance(borrowed<double> h) &
    {
        scene_.undeformed_distance = per_element("undeformed_distance", h);
        return *this;
    }
    /// The approach or the force is given; the one that is set last.
    scene &approach(double value) &
    {
        scene_.load = CONTACT_NORMAL_PRESCRIBED_APPROACH, scene_.approach = value;
        return *this;
    }
    scene &force(double value) &
    {
        scene_.load = CONTACT_NORMAL_PRESCRIBED_FORCE, scene_.force = value;
        return *this;
    }

    /// Own influence coefficients, 2 cy * 2 cx values.
    scene &influence(std::int32_t cx, std::int32_t cy, borrowed<double> coefficients, double scale = 1.0) &
    {
        influence_ = detail::table("influence", cx, cy, coefficients, scale);
        return *this;
    }
    /// Own coefficients of each loaded row, my * my * 2 cx values.
    scene &row_tables(std::int32_t cx, borrowed<double> coefficients, double scale = 1.0) &
    {
        contact_normal_row_tables_init(&row_tables_.emplace());
        const std::size_t my = detail::count(scene_.my);
        row_tables_->cx = cx, row_tables_->rows = scene_.my, row_tables_->scale = scale;
        row_tables_->coefficients = detail::sized("row_tables", coefficients, 2 * detail::count(cx) * my * my);
        return *this;
    }
    /// A thin compliant layer: of one compliance, or of one per element.
    scene &layer(double compliance) &
    {
        contact_normal_layer_init(&layer_.emplace());
        layer_->compliance = compliance;
        return *this;
    }
    scene &layer(borrowed<double> compliances) &
    {
        contact_normal_layer_init(&layer_.emplace());
        layer_->compliances = per_element("layer", compliances);
        return *this;
    }
    /// A coating on body 1 or 2 of the scene: an elastic layer of this thickness and material, bonded to the body, which may be rigid.
    scene &coating(std::size_t body, double thickness, const contact_normal::body &material) &
    {
        if (body < 1 || body > 2) detail::refuse("body is " + std::to_string(body) + "; it must be 1 or 2");
        std::optional<contact_normal_coating> &coating = coating_[body - 1];
        contact_normal_coating_init(&coating.emplace());
        coating->thickness = thickness, coating->shear_modulus = material.shear_modulus;
        coating->poisson_ratio = material.poisson_ratio;
        return *this;
    }
    /// No pressure is larger: one limit, or one per element.
    scene &pressure_limit(double limit) &
    {
        contact_normal_pressure_limit_init(&pressure_limit_.emplace());
        pressure_limit_->limit = limit;
        return *this;
    }
    scene &pressure_limit(borrowed<double> limits) &
    {
        contact_normal_pressure_limit_init(&pressure_limit_.emplace());
        pressure_limit_->limits = per_element("pressure_limit", limits);
        return *this;
    }
    /// Friction between the bodies.
    scene &friction(const contact_normal::friction &of) &
    {
        friction_ = of.named(size());
        tables_ = of.tables_;
        friction_row_tables_ = of.row_tables_;
        return *this;
    }
    /// Attraction between the bodies.
    scene &adhesion(const contact_normal::adhesion &of) &
    {
        adhesion_ = of.named(size());
        return *this;
    }
    /// Bodies that relax, and a step of time of them. The arrays must live as long as the scene is solved.
    scene &visco(const contact_normal::visco &of) &
    {
        visco_ = of.named();
        return *this;
    }
    /// The grid is one period in x, in y, or in both.
    scene &period(bool x, bool y) &
    {
        contact_normal_period_init(&period_.emplace());
        period_->x = x, period_->y = y;
        return *this;
    }
    /// The patch of each element, 0 to patches - 1, and the patches * patches factors of their interaction.
    scene &patches(std::int32_t patches, borrowed<std::int32_t> patch, borrowed<double> factors) &
    {
        contact_normal_patches_init(&patches_.emplace());
        patches_->count = patches, patches_->patch = per_element("patches", patch);
        patches_->factors = detail::sized("patches' factors", factors, detail::count(patches) * detail::count(patches));
        return *this;
    }

    // The same of a temporary, which moves: `const auto &of = scene(grid, steel).force(1.0)` lives on.
    scene undeformed_distance(borrowed<double> h) && { return std::move(undeformed_distance(h)); }
    scene approach(double value) && { return std::move(approach(value)); }
    scene force(double value) && { return std::move(force(value)); }
    scene influence(std::int32_t cx, std::int32_t cy, borrowed<double> coefficients, double scale = 1.0) &&
    {
        return std::move(influence(cx, cy, coefficients, scale));
    }
    scene row_tables(std::int32_t cx, borrowed<double> coefficients, double scale = 1.0) &&
    {
        return std::move(row_tables(cx, coefficients, scale));
    }
    scene layer(double compliance) && { return std::move(layer(compliance)); }
    scene layer(borrowed<double> compliances) && { return std::move(layer(compliances)); }
    scene coating(std::size_t body, double thickness, const contact_normal::body &material) &&
    {
        return std::move(coating(body, thickness, material));
    }
    scene pressure_limit(double limit) && { return std::move(pressure_limit(limit)); }
    scene pressure_limit(borrowed<double> limits) && { return std::move(pressure_limit(limits)); }
    scene friction(const contact_normal::friction &of) && { return std::move(friction(of)); }
    scene adhesion(const contact_normal::adhesion &of) && { return std::move(adhesion(of)); }
    scene visco(const contact_normal::visco &of) && { return std::move(visco(of)); }
    scene period(bool x, bool y) && { return std::move(period(x, y)); }
    scene patches(std::int32_t patches, borrowed<std::int32_t> patch, borrowed<double> factors) &&
    {
        return std::move(this->patches(patches, patch, factors));
    }

    /// The scene of the C ABI, valid as long as this one and the arrays. It points into this one, so a temporary has none.
    contact_normal_scene get() const &
    {
        contact_normal_scene named = scene_;
        named.influence = influence_ ? &*influence_ : nullptr;
        named.layer = layer_ ? &*layer_ : nullptr;
        named.pressure_limit = pressure_limit_ ? &*pressure_limit_ : nullptr;
        named.period = period_ ? &*period_ : nullptr;
        named.patches = patches_ ? &*patches_ : nullptr;
        named.row_tables = row_tables_ ? &*row_tables_ : nullptr;
        named.friction = friction_ ? &*friction_ : nullptr;
        named.adhesion = adhesion_ ? &*adhesion_ : nullptr;
        named.visco = visco_ ? &*visco_ : nullptr;
        for (std::size_t body : {0u, 1u}) named.coating[body] = coating_[body] ? &*coating_[body] : nullptr;
        return named;
    }
    contact_normal_scene get() const && = delete;

    /// Elements of the grid.
    std::size_t size() const noexcept { return detail::count(scene_.mx) * detail::count(scene_.my); }
    bool has_friction() const noexcept { return friction_.has_value(); }
    bool has_adhesion() const noexcept { return adhesion_.has_value(); }

private:
    template <class T> const T *per_element(const char *name, borrowed<T> values) const
    {
        return detail::sized(name, values, size());
    }

    contact_normal_scene scene_;
    std::optional<contact_normal_influence> influence_;
    std::optional<contact_normal_layer> layer_;
    std::optional<contact_normal_pressure_limit> pressure_limit_;
    std::optional<contact_normal_period> period_;
    std::optional<contact_normal_patches> patches_;
    std::optional<contact_normal_row_tables> row_tables_;
    std::array<std::optional<contact_normal_coating>, 2> coating_;
    std::optional<contact_normal_friction> friction_;
    std::optional<contact_normal_adhesion> adhesion_;
    std::optional<contact_normal_visco> visco_;
    // What `friction_` points to.
    std::shared_ptr<const contact_normal::friction::tables> tables_;
    std::shared_ptr<const std::array<contact_normal_row_tables, 3>> friction_row_tables_;
};

namespace detail {

/// Elements of a scene for which arrays get room: none if they are too many, for the library refuses such a grid.
inline std::size_t room_of(const scene &of) noexcept { return of.size() <= 0x7fffffffu ? of.size() : 0; }

} // namespace detail

} // namespace contact_normal

#endif // CONTACT_NORMAL_SCENE_HPP
