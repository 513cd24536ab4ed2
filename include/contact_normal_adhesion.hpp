// contact_normal.hpp: adhesion, an effect of a scene.
#ifndef CONTACT_NORMAL_ADHESION_HPP
#define CONTACT_NORMAL_ADHESION_HPP

#include <contact_normal_arrays.hpp>

#include <optional>

namespace contact_normal {

/// Attraction across the gap: `contact_normal_adhesion`. Each member function returns the adhesion.
class adhesion {
public:
    /// One work of adhesion, or one per element.
    explicit adhesion(double work) { contact_normal_adhesion_init(&adhesion_), adhesion_.work_of_adhesion = work; }
    explicit adhesion(borrowed<double> works) : adhesion(0.0) { works_ = works; }

    /// The range, a length; 0: the shortest that the elements carry.
    adhesion &range(double length)
    {
        adhesion_.range = length;
        return *this;
    }
    /// CONTACT_NORMAL_LAW_..., and of DUGDALE the part of the range over which its edge is smeared.
    adhesion &law(std::int32_t kind, double smear = 0.3)
    {
        adhesion_.law = kind, adhesion_.smear = smear;
        return *this;
    }
    /// CONTACT_NORMAL_START_...: which of several states is looked for.
    adhesion &start(std::int32_t from)
    {
        adhesion_.start = from;
        return *this;
    }
    /// dF/dapproach is wanted.
    adhesion &stiffness()
    {
        adhesion_.stiffness = 1;
        return *this;
    }

    /// How near the state is to a snap is wanted.
    adhesion &stability()
    {
        adhesion_.stability = 1;
        return *this;
    }
    /// A traction that adds to the bound of friction in contact.
    adhesion &shear_strength(double strength)
    {
        adhesion_.shear_strength = strength;
        return *this;
    }

    /// The struct of the C ABI, for a grid of so many elements.
    contact_normal_adhesion named(std::size_t size) const
    {
        contact_normal_adhesion of = adhesion_;
        if (works_) of.works_of_adhesion = detail::sized("works_of_adhesion", *works_, size);
        return of;
    }

private:
    contact_normal_adhesion adhesion_;
    std::optional<borrowed<double>> works_;
};

} // namespace contact_normal

#endif // CONTACT_NORMAL_ADHESION_HPP
