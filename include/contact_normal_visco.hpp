// contact_normal.hpp: bodies that relax, an effect of a scene.
#ifndef CONTACT_NORMAL_VISCO_HPP
#define CONTACT_NORMAL_VISCO_HPP

#include <contact_normal_arrays.hpp>

#include <array>
#include <cstddef>
#include <string>

namespace contact_normal {

/// Bodies that relax, and a step of time of them: `contact_normal_visco`. Each member function returns it.
class visco {
public:
    /// A step of this time; 0: a jump.
    explicit visco(double time_step = 0.0) { contact_normal_visco_init(&visco_), visco_.time_step = time_step; }

    /// Moduli and times of the branches of body 1 or 2, as many of each.
    visco &branches(std::size_t body, borrowed<double> modulus, borrowed<double> time)
    {
        if (body < 1 || body > 2) detail::refuse("body is " + std::to_string(body) + "; it must be 1 or 2");
        visco_.branches[body - 1] = static_cast<std::int32_t>(modulus.size());
        visco_.modulus[body - 1] = modulus.data();
        visco_.time[body - 1] = detail::sized("visco's time", time, modulus.size());
        return *this;
    }
    /// The time of the step.
    visco &time_step(double time)
    {
        visco_.time_step = time;
        return *this;
    }
    /// CONTACT_NORMAL_FORM_...: what is linear in the step.
    visco &form(std::int32_t kind)
    {
        visco_.form = kind;
        return *this;
    }
    /// The step begins where the last one of the solver ended.
    visco &continues(bool yes = true)
    {
        visco_.continues = yes;
        return *this;
    }

    /// The struct of the C ABI, valid as long as the arrays.
    contact_normal_visco named() const { return visco_; }

private:
    contact_normal_visco visco_;
};

} // namespace contact_normal

#endif // CONTACT_NORMAL_VISCO_HPP
