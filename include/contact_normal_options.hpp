// contact_normal.hpp: how a scene is solved, and what watches it.
#ifndef CONTACT_NORMAL_OPTIONS_HPP
#define CONTACT_NORMAL_OPTIONS_HPP

#include <contact_normal_arrays.hpp>

#include <atomic>
#include <exception>
#include <functional>
#include <string>

namespace contact_normal {

/// Any thread may set it while another one solves with options that `stop_by` it: the call then ends as CANCELLED after its cycle.
/// It must live until then, at the same place.
class stop_flag {
public:
    stop_flag() = default;
    stop_flag(const stop_flag &) = delete;
    stop_flag &operator=(const stop_flag &) = delete;

    void set() noexcept { value_.store(1, std::memory_order_relaxed); }
    void clear() noexcept { value_.store(0, std::memory_order_relaxed); }
    bool is_set() const noexcept { return value_.load(std::memory_order_relaxed) != 0; }

    /// What the member `stop` of the options points to.
    const std::int32_t *get() const & noexcept { return reinterpret_cast<const std::int32_t *>(&value_); }
    const std::int32_t *get() const && = delete;

private:
    std::atomic<std::int32_t> value_{0};
    static_assert(sizeof(std::atomic<std::int32_t>) == sizeof(std::int32_t) && std::atomic<std::int32_t>::is_always_lock_free,
                  "an atomic integer of this machine is an integer that is read and written at once, as the library reads it");
};

/// The cycle of the paper's methods: `contact_normal_cycle`, filled with the defaults.
struct cycle : contact_normal_cycle {
    cycle() { contact_normal_cycle_init(this); }

    /// Sets a member by its name to what a text says: ("smoother", "RED_BLACK").
    cycle &set(const std::string &name, const std::string &value)
    {
        check(contact_normal_set_cycle_option(this, name.c_str(), value.c_str()));
        return *this;
    }
};

/// How a scene is solved: `contact_normal_options`, filled with the defaults. Its members `cycle`, `stop` and `dump`, the path of a file, are pointers: what
/// they point to must live until the solve is over.
struct options : contact_normal_options {
    options() { contact_normal_options_init(this); }

    /// Sets `stop`, and `cycle`.
    options &stop_by(const stop_flag &flag)
    {
        stop = flag.get();
        return *this;
    }
    options &stop_by(const stop_flag &&) = delete;
    options &use_cycle(const contact_normal_cycle &of)
    {
        cycle = &of;
        return *this;
    }
    options &use_cycle(const contact_normal_cycle &&) = delete;

    /// Sets a member by its name to what a text says: ("method", "PROJECTED_CG"), for hosts with input files.
    options &set(const std::string &name, const std::string &value)
    {
        check(contact_normal_set_option(this, name.c_str(), value.c_str()));
        return *this;
    }
};

/// Called after each cycle; true cancels. What it throws cancels too, and comes through.
using progress = std::function<bool(const contact_normal_progress &)>;

namespace detail {

/// A callback of C++, and what it threw.
template <class Call> struct watched {
    const Call &call;
    std::exception_ptr thrown;

    template <class... Arguments> std::int32_t run(Arguments &&...arguments) noexcept
    {
        try {
            return call(std::forward<Arguments>(arguments)...) ? 1 : 0;
        } catch (...) {
            thrown = std::current_exception();
            return 1;
        }
    }
    void rethrow() const
    {
        if (thrown) std::rethrow_exception(thrown);
    }
};

inline std::int32_t on_progress(const contact_normal_progress *told, void *user) noexcept
{
    return static_cast<watched<progress> *>(user)->run(*told);
}

/// Options whose progress callback is `told`, if it is one.
class watched_options {
public:
    watched_options(const contact_normal_options &how, const progress &told) : options_(how), watched_{told, nullptr}
    {
        if (told) options_.progress = on_progress, options_.user = &watched_;
    }
    watched_options(const watched_options &) = delete;
    watched_options &operator=(const watched_options &) = delete;

    const contact_normal_options *get() const noexcept { return &options_; }
    void rethrow() const { watched_.rethrow(); }

private:
    contact_normal_options options_;
    watched<progress> watched_;
};

} // namespace detail

} // namespace contact_normal

#endif // CONTACT_NORMAL_OPTIONS_HPP
