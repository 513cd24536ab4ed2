// contact_normal.hpp: friction, an effect of a scene.
#ifndef CONTACT_NORMAL_FRICTION_HPP
#define CONTACT_NORMAL_FRICTION_HPP

#include <contact_normal_arrays.hpp>

#include <array>
#include <memory>
#include <optional>

namespace contact_normal {

/// Friction between the bodies: `contact_normal_friction`. Each member function returns the friction; directions are 0 for x, 1 for y.
class friction {
public:
    /// One coefficient, or one per element.
    explicit friction(double coefficient) { contact_normal_friction_init(&friction_), friction_.coefficient = coefficient; }
    explicit friction(borrowed<double> coefficients) : friction(0.0) { coefficients_ = coefficients; }

    /// CONTACT_NORMAL_MOTION_..., and of rolling the length of the step (0: dx) and the direction (radians from the x axis).
    friction &motion(std::int32_t kind, double rolling_distance = 0.0, double rolling_direction = 0.0)
    {
        friction_.motion = kind;
        friction_.rolling_distance = rolling_distance, friction_.rolling_direction = rolling_direction;
        return *this;
    }
    /// The creepage in a direction is given, or the force is.
    friction &creepage(std::size_t direction, double value)
    {
        friction_.prescribed[checked(direction)] = CONTACT_NORMAL_PRESCRIBED_CREEPAGE, friction_.creepage[direction] = value;
        return *this;
    }
    friction &force(std::size_t direction, double value)
    {
        friction_.prescribed[checked(direction)] = CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE, friction_.force[direction] = value;
        return *this;
    }
    /// The spin, about a place counted from the middle of the grid.
    friction &spin(double value, double centre_x = 0.0, double centre_y = 0.0)
    {
        friction_.spin = value, friction_.spin_centre[0] = centre_x, friction_.spin_centre[1] = centre_y;
        return *this;
    }
    /// In rolling with spin: the part of the step by which places are ahead.
    friction &spin_offset(double part)
    {
        friction_.spin_offset = part;
        return *this;
    }
    /// The tractions before, in x and y; or those that the solver found last.
    friction &previous_traction(borrowed<double> x, borrowed<double> y)
    {
        previous_ = std::array<borrowed<double>, 2>{x, y};
        return *this;
    }
    friction &continues()
    {
        friction_.continues = 1;
        return *this;
    }
    /// A rigid slip in addition, in x and y.
    friction &rigid_slip(borrowed<double> x, borrowed<double> y)
    {
        slip_ = std::array<borrowed<double>, 2>{x, y};
        return *this;
    }
    /// Tractions in x and y to start the iteration from.
    friction &initial_traction(borrowed<double> x, borrowed<double> y)
    {
        initial_ = std::array<borrowed<double>, 2>{x, y};
        return *this;
    }
    /// The compliance of a thin elastic layer between the bodies: one, or one per element.
    friction &compliance(double value)
    {
        friction_.compliance = value;
        return *this;
    }
    friction &compliances(borrowed<double> values)
    {
        compliances_ = values;
        return *this;
    }
    /// How the coefficient falls with the slip velocity, in one part: CONTACT_NORMAL_FRICTION_LAW_... `of_step`: the speed of rolling, or the time
    /// that a shift takes.
    friction &law(std::int32_t kind, double kinetic, double falling, double half_speed, double of_step)
    {
        friction_.law = kind;
        friction_.kinetic = kinetic;
        friction_.falling[0] = falling;
        friction_.half_speed[0] = half_speed;
        friction_.speed = friction_.time_step = of_step;
        return *this;
    }
    /// A second part that falls.
    friction &also_falling(double falling, double half_speed)
    {
        friction_.falling[1] = falling;
        friction_.half_speed[1] = half_speed;
        return *this;
    }
    /// The coefficient follows over this distance of slip, by this slip velocity at least.
    friction &memory(double distance, double speed)
    {
        friction_.memory_distance = distance;
        friction_.memory_speed = speed;
        return *this;
    }
    /// CONTACT_NORMAL_FRICTION_BRANCH_...: which solution of a law.
    friction &branch(std::int32_t which)
    {
        friction_.branch = which;
        return *this;
    }
    /// A layer that yields.
    friction &layer(double yield_limit, double hardening = 0.0)
    {
        friction_.yield_limit = yield_limit;
        friction_.hardening = hardening;
        return *this;
    }
    /// What particles of the interface had before the step.
    friction &previous_coefficient(borrowed<double> values)
    {
        coefficient_before_ = values;
        return *this;
    }
    friction &previous_yield_limit(borrowed<double> values)
    {
        yield_limit_before_ = values;
        return *this;
    }
    /// How much of a creepage in x, in y reaches each element.
    friction &creepage_weight(borrowed<double> x, borrowed<double> y)
    {
        weights_ = std::array<borrowed<double>, 2>{x, y};
        return *this;
    }
    /// Own tangential influence coefficients instead of the half-space's, 2 cy * 2 cx values each.
    friction &influence(std::int32_t cx, std::int32_t cy, borrowed<double> xx, borrowed<double> yy, borrowed<double> xy, double scale = 1.0)
    {
        auto own = std::make_shared<tables>();
        const std::array<const borrowed<double> *, 3> given{&xx, &yy, &xy};
        for (std::size_t k = 0; k < 3; k++) own->main[k] = detail::table("friction's influence", cx, cy, *given[k], scale);
        tables_ = std::move(own);
        return *this;
    }
    /// And those of unlike bodies; call it after `influence`, whose cx, cy and scale they have.
    friction &influence_cross(borrowed<double> xz, borrowed<double> yz)
    {
        if (!tables_) detail::refuse("friction's influence_cross is given without influence; call influence first");
        auto own = std::make_shared<tables>(*tables_);
        const contact_normal_influence &as = own->main[0];
        own->cross = {detail::table("friction's influence_cross", as.cx, as.cy, xz, as.scale),
                      detail::table("friction's influence_cross", as.cx, as.cy, yz, as.scale)};
        own->has_cross = true;
        tables_ = std::move(own);
        return *this;
    }
    /// Own tangential coefficients that differ per loaded row, rows * rows * 2 cx values each, instead of `influence`.
    friction &row_tables(std::int32_t cx, std::int32_t rows, borrowed<double> xx, borrowed<double> yy, borrowed<double> xy, double scale = 1.0)
    {
        auto own = std::make_shared<std::array<contact_normal_row_tables, 3>>();
        const std::array<const borrowed<double> *, 3> given{&xx, &yy, &xy};
        for (std::size_t k = 0; k < 3; k++) (*own)[k] = detail::row_tables("friction's row_tables", cx, rows, *given[k], scale);
        row_tables_ = std::move(own);
        return *this;
    }
    /// Derivatives of forces and moment, in `report.tangential.sensitivities`.
    friction &sensitivities()
    {
        friction_.sensitivities = 1;
        return *this;
    }

private:
    friend class scene;
    friend class solver;

    struct tables {
        std::array<contact_normal_influence, 3> main;
        std::array<contact_normal_influence, 2> cross;
        bool has_cross = false;
    };

    static std::size_t checked(std::size_t direction)
    {
        if (direction < 2) return direction;
        detail::refuse("direction is " + std::to_string(direction) + "; it must be 0 for x or 1 for y");
    }

    /// That of the C ABI, for a grid of so many elements; valid as long as the tables and the arrays.
    contact_normal_friction named(std::size_t elements) const
    {
        contact_normal_friction named = friction_;
        if (coefficients_) named.coefficients = detail::sized("friction's coefficients", *coefficients_, elements);
        for (std::size_t k = 0; k < 2; k++) {
            if (previous_) named.previous_traction[k] = detail::sized("friction's previous_traction", (*previous_)[k], elements);
            if (slip_) named.rigid_slip[k] = detail::sized("friction's rigid_slip", (*slip_)[k], elements);
            if (initial_) named.initial_traction[k] = detail::sized("friction's initial_traction", (*initial_)[k], elements);
            if (weights_) named.creepage_weight[k] = detail::sized("friction's creepage_weight", (*weights_)[k], elements);
        }
        if (compliances_) named.compliances = detail::sized("friction's compliances", *compliances_, elements);
        if (coefficient_before_)
            named.previous_coefficient = detail::sized("friction's previous_coefficient", *coefficient_before_, elements);
        if (yield_limit_before_)
            named.previous_yield_limit = detail::sized("friction's previous_yield_limit", *yield_limit_before_, elements);
        return with_tables(named);
    }

    /// The same with nothing but its tables.
    contact_normal_friction tables_alone() const
    {
        contact_normal_friction named;
        contact_normal_friction_init(&named);
        return with_tables(named);
    }

    contact_normal_friction with_tables(contact_normal_friction named) const
    {
        for (std::size_t k = 0; k < 2; k++) named.influence_cross[k] = tables_ && tables_->has_cross ? &tables_->cross[k] : nullptr;
        for (std::size_t k = 0; k < 3; k++) named.influence[k] = tables_ ? &tables_->main[k] : nullptr;
        for (std::size_t k = 0; k < 3; k++) named.row_tables[k] = row_tables_ ? &(*row_tables_)[k] : nullptr;
        return named;
    }

    contact_normal_friction friction_;
    std::optional<borrowed<double>> coefficients_, compliances_, coefficient_before_, yield_limit_before_;
    std::optional<std::array<borrowed<double>, 2>> previous_, slip_, initial_, weights_;
    // Shared by copies, and never changed.
    std::shared_ptr<const tables> tables_;
    std::shared_ptr<const std::array<contact_normal_row_tables, 3>> row_tables_;
};

} // namespace contact_normal

#endif // CONTACT_NORMAL_FRICTION_HPP
