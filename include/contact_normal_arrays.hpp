// contact_normal.hpp, the first part: errors, arrays of the caller's, the grid and the bodies.
#ifndef CONTACT_NORMAL_ARRAYS_HPP
#define CONTACT_NORMAL_ARRAYS_HPP

#include <contact_normal.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#if __cplusplus >= 202002L
#include <span>
#endif

namespace contact_normal {

/// What is thrown for a negative status: `what()` names the argument, its value and the rule.
class error : public std::runtime_error {
public:
    error(contact_normal_status status, const std::string &message) : std::runtime_error(message), status_(status) {}
    contact_normal_status status() const noexcept { return status_; }

private:
    contact_normal_status status_;
};

/// Throws `error` if `status` is negative.
inline contact_normal_status check(contact_normal_status status)
{
    if (status < 0) throw error(status, contact_normal_last_error());
    return status;
}

/// Contiguous values of the caller's that are read during a call: a std::vector, std::array, std::span, C array, or a pointer and
/// a count. A temporary will do.
template <class T> class view {
public:
    view(const T *data, std::size_t size) : data_(data), size_(size) {}
    /// Values in braces, as an argument: they live as long as the call.
    view(std::initializer_list<T> values) : view(values.begin(), values.size()) {}
    template <class C, class = std::enable_if_t<std::is_convertible_v<decltype(std::data(std::declval<const C &>())), const T *>>>
    view(const C &container) : data_(std::data(container)), size_(std::size(container))
    {
    }
    const T *data() const noexcept { return data_; }
    std::size_t size() const noexcept { return size_; }

private:
    const T *data_;
    std::size_t size_;
};

namespace detail {

template <class C> using bare = std::remove_cv_t<std::remove_reference_t<C>>;

template <class C, class T, class = void> struct has_values : std::false_type {};
template <class C, class T>
struct has_values<C, T, std::void_t<decltype(std::data(std::declval<const std::remove_reference_t<C> &>()))>>
    : std::is_convertible<decltype(std::data(std::declval<const std::remove_reference_t<C> &>())), const T *> {};

template <class C> struct is_view : std::false_type {};
template <class T> struct is_view<view<T>> : std::true_type {};

/// Whether the values of a container live on when this expression is over.
template <class C> constexpr bool lives_on()
{
    if (is_view<bare<C>>::value) return false; // it may be one of a temporary
#if defined(__cpp_lib_span) && defined(__cpp_lib_ranges)
    if (std::ranges::enable_borrowed_range<bare<C>>) return true;
#endif
    return std::is_lvalue_reference_v<C>;
}

} // namespace detail

/// Contiguous values of the caller's that are read after the call, too: they must live on. So a temporary does not compile, but a
/// std::span of an array that lives on does. A pointer and a count are taken as they are.
template <class T> class borrowed {
    template <class C>
    static constexpr bool fits = detail::has_values<C, T>::value && !std::is_same_v<detail::bare<C>, borrowed>;

public:
    borrowed(const T *data, std::size_t size) : data_(data), size_(size) {}
    /// Two numbers in braces are no pointer and count, also where the first is a 0.
    template <class N, std::enable_if_t<std::is_integral_v<N>, int> = 0> borrowed(N, std::size_t) = delete;
    template <class C, std::enable_if_t<fits<C> && detail::lives_on<C>(), int> = 0>
    borrowed(C &&container) : data_(std::data(container)), size_(std::size(container))
    {
    }
    /// The values of a temporary are gone when they are read.
    template <class C, std::enable_if_t<fits<C> && !detail::lives_on<C>(), int> = 0> borrowed(C &&temporary) = delete;
    const T *data() const noexcept { return data_; }
    std::size_t size() const noexcept { return size_; }

private:
    const T *data_;
    std::size_t size_;
};

/// Elements in x and y, and their sizes.
struct grid {
    std::int32_t mx, my;
    double dx, dy;
};

/// Shear modulus (a pressure; infinity: rigid) and Poisson's ratio of a body.
struct body {
    double shear_modulus, poisson_ratio;
};

namespace detail {

inline std::size_t count(std::int32_t m) noexcept { return m > 0 ? static_cast<std::size_t>(m) : 0; }

[[noreturn]] inline void refuse(const std::string &message) { throw error(CONTACT_NORMAL_INVALID_ARGUMENT, message); }

inline std::string wrong_size(const std::string &name, std::size_t size, std::size_t wanted)
{
    return name + " has " + std::to_string(size) + " values; it must have " + std::to_string(wanted);
}

/// How many coefficients a table of these offsets has; one if they are too many, for the library refuses such a table.
inline std::size_t table_size(std::int32_t cx, std::int32_t cy) noexcept
{
    const std::size_t most = static_cast<std::size_t>(PTRDIFF_MAX) / sizeof(double) / 4;
    return count(cx) * count(cy) <= most ? 4 * count(cx) * count(cy) : 1;
}

/// The values of an array, which must have so many.
template <class Values> auto sized(const char *name, const Values &values, std::size_t size)
{
    if (values.size() != size) refuse(wrong_size(name, values.size(), size));
    return values.data();
}

/// The same where an array of no values means none.
template <class Values> auto sized_or_none(const char *name, const Values &values, std::size_t size)
{
    return values.size() == 0 ? nullptr : sized(name, values, size);
}

inline std::int32_t narrow(const char *name, std::size_t n)
{
    if (n <= 0x7fffffffu) return static_cast<std::int32_t>(n);
    refuse(std::string("there are more than 2^31 - 1 ") + name);
}

/// Own coefficients of offsets -cx..cx-1 by -cy..cy-1.
template <class Values>
contact_normal_influence table(const char *name, std::int32_t cx, std::int32_t cy, const Values &coefficients, double scale)
{
    contact_normal_influence made;
    contact_normal_influence_init(&made);
    made.cx = cx, made.cy = cy, made.scale = scale;
    made.coefficients = sized(name, coefficients, 4 * count(cx) * count(cy));
    return made;
}

/// Coefficients that differ per loaded row, rows * rows * 2 cx values, as the C ABI takes them.
template <class Values>
contact_normal_row_tables row_tables(const char *name, std::int32_t cx, std::int32_t rows, const Values &coefficients, double scale)
{
    contact_normal_row_tables made;
    contact_normal_row_tables_init(&made);
    made.cx = cx, made.rows = rows, made.scale = scale;
    made.coefficients = sized(name, coefficients, 2 * count(cx) * count(rows) * count(rows));
    return made;
}

} // namespace detail

} // namespace contact_normal

#endif // CONTACT_NORMAL_ARRAYS_HPP
