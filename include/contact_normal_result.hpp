// contact_normal.hpp: what a solve found.
#ifndef CONTACT_NORMAL_RESULT_HPP
#define CONTACT_NORMAL_RESULT_HPP

#include <contact_normal_arrays.hpp>
#include <contact_normal_scene.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace contact_normal {

/// Arrays of a result: `fields::pressure | fields::contact` are two of them.
enum class fields : std::uint32_t {
    none = 0,
    pressure = 1,
    deformed_distance = 2,
    displacement = 4,
    contact = 8,
    traction = 16,
    slip = 32,
    stick_slip = 64,
    ledger = 128, // the estimated errors, too
    contact_pressure = 256,
    attraction = 512,
    friction_coefficient = 1024,
    yield_limit = 2048,
    all = 4095
};
constexpr fields operator|(fields a, fields b) noexcept
{
    return static_cast<fields>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr fields operator&(fields a, fields b) noexcept
{
    return static_cast<fields>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
constexpr fields operator-(fields a, fields b) noexcept
{
    return static_cast<fields>(static_cast<std::uint32_t>(a) & ~static_cast<std::uint32_t>(b));
}

namespace detail {
struct outputs;
constexpr fields of_friction = fields::traction | fields::slip | fields::stick_slip | fields::friction_coefficient | fields::yield_limit;
constexpr fields of_adhesion = fields::contact_pressure | fields::attraction;
} // namespace detail

/// What a solve found. The arrays have my * mx values, x fastest; those that it does not hold are empty.
struct result {
    contact_normal_status status = CONTACT_NORMAL_OK;
    std::string message; // why, if the status is not OK, and what report.warnings mean
    std::vector<double> pressure, deformed_distance, displacement;
    std::vector<std::int32_t> contact; // 0: exterior, 1: contact, 2: at the pressure limit
    std::array<std::vector<double>, 2> traction, slip; // in x and y; with friction only
    std::vector<std::int32_t> stick_slip;                // 0: exterior, 1: stick, 2: slip, 3: in a layer that yields; with friction only
    std::vector<double> friction_coefficient, yield_limit; // what particles of the interface carry; with friction only
    std::vector<double> contact_pressure, attraction; // q and sigma, whose difference is p; with adhesion only
    contact_normal_report report;
    std::vector<contact_normal_ledger_row> ledger; // coarsest grid first

    /// A result for `solve_into`, which asks for these arrays. Each costs a copy; the ledger costs an estimate of the errors, and is
    /// not among the defaults.
    explicit result(fields of = fields::all - fields::ledger) : asked(of) { contact_normal_report_init(&report); }

    /// What the next solve into it writes, but for what friction or adhesion alone has if there is none.
    fields asked;
    /// Whether the last solve wrote all of these.
    bool holds(fields which) const noexcept { return (held_ & which) == which; }
    /// True if the contact conditions hold to the tolerance.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }

private:
    friend struct detail::outputs;
    fields held_ = fields::none;
};

namespace detail {

// One row per grid, each with half the elements in a direction: mx and my are 32-bit.
constexpr std::size_t ledger_room = 32;

/// Where the library writes what a result asks for.
struct outputs {
    contact_normal_fields written;
    std::array<contact_normal_ledger_row, ledger_room> rows; // begun only if the ledger is asked for
    fields writes;

    /// Points to the arrays of `found`. Where the start is given, pressures (and the contact area, if there is one) are read. Returns
    /// what is wrong with it.
    std::string begin(const scene &of, result &found, const contact_normal_options &how)
    {
        const std::size_t size = room_of(of);
        const bool is_given = how.initial_guess == CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
        const bool is_fixed = how.active_set == CONTACT_NORMAL_ACTIVE_SET_FIXED;
        if (is_given && found.pressure.size() != size) return wrong_size("found.pressure, the start,", found.pressure.size(), size);
        const bool has_contact = found.contact.size() == size;
        if (is_fixed && !has_contact) return wrong_size("found.contact, which is fixed,", found.contact.size(), size);
        fields reads = is_given ? fields::pressure : fields::none;
        if (is_fixed || (is_given && has_contact)) reads = reads | fields::contact;
        writes = had_by(of, found.asked);
        if (is_given && !has_contact && has(writes, fields::contact)) {
            found.contact.clear();
            for (double p : found.pressure) found.contact.push_back(p > 0.0);
        }
        point(found, writes | reads, size);
        return {};
    }

    /// Points to arrays of this size, and begins the report.
    void point(result &found, fields which, std::size_t size)
    {
        contact_normal_fields_init(&written);
        written.pressure = room(found.pressure, has(which, fields::pressure), size);
        written.contact = room(found.contact, has(which, fields::contact), size);
        written.deformed_distance = room(found.deformed_distance, has(which, fields::deformed_distance), size);
        written.displacement = room(found.displacement, has(which, fields::displacement), size);
        for (std::size_t k : {0u, 1u}) {
            written.traction[k] = room(found.traction[k], has(which, fields::traction), size);
            written.slip[k] = room(found.slip[k], has(which, fields::slip), size);
        }
        written.stick_slip = room(found.stick_slip, has(which, fields::stick_slip), size);
        written.friction_coefficient = room(found.friction_coefficient, has(which, fields::friction_coefficient), size);
        written.yield_limit = room(found.yield_limit, has(which, fields::yield_limit), size);
        written.contact_pressure = room(found.contact_pressure, has(which, fields::contact_pressure), size);
        written.attraction = room(found.attraction, has(which, fields::attraction), size);
        contact_normal_report_init(&found.report);
        if (has(which, fields::ledger)) {
            contact_normal_ledger_row_init(rows.data());
            found.report.ledger = rows.data(), found.report.ledger_capacity = ledger_room;
        }
    }

    /// Notes how it ended. A refused solve has written nothing.
    void end(result &found, contact_normal_status status, const char *message) const
    {
        without_ledger(found.report);
        found.status = status;
        found.message = message;
        found.held_ = status < 0 ? fields::none : writes;
        found.ledger.assign(rows.data(), rows.data() + (found.holds(fields::ledger) ? found.report.ledger_rows : 0));
    }
    /// Of the last call on this thread.
    void end(result &found, contact_normal_status status) const
    {
        const bool is_silent = status == CONTACT_NORMAL_OK && found.report.warnings == 0;
        end(found, status, is_silent ? "" : contact_normal_last_error());
    }

    /// Notes that a call was refused before the library saw it: the report is a new one, and nothing is held. Arrays stay, for they may be a start.
    static void refuse(result &found, contact_normal_status status, const std::string &why)
    {
        contact_normal_report_init(&found.report);
        found.held_ = fields::none;
        found.ledger.clear();
        found.status = status;
        found.message = why;
    }

    /// Takes away the place of the ledger, which ends with the call.
    static void without_ledger(contact_normal_report &report) noexcept { report.ledger = nullptr, report.ledger_capacity = 0; }

    /// Of what is asked for, what the result of a scene has.
    static fields had_by(const scene &of, fields asked) noexcept
    {
        const fields with_friction = of.has_friction() ? asked : asked - of_friction;
        return of.has_adhesion() ? with_friction : with_friction - of_adhesion;
    }

    /// Adds the rows of a ledger to a result that was written otherwise.
    static void add_ledger(result &found, fields asked, const std::vector<contact_normal_ledger_row> &rows)
    {
        if (!has(asked, fields::ledger)) return;
        found.ledger.assign(rows.data(), rows.data() + std::min<std::int64_t>(found.report.ledger_rows, ledger_room));
        found.held_ = found.held_ | fields::ledger;
    }

private:
    static bool has(fields of, fields one) noexcept { return (of & one) != fields::none; }

    /// The place of an array of this size, if it is wanted.
    template <class T> static T *room(std::vector<T> &values, bool wanted, std::size_t size)
    {
        values.resize(wanted ? size : 0);
        return wanted ? values.data() : nullptr;
    }
};

/// Gives each problem its lines of the message of a batch.
inline void share_message(const std::string &message, std::vector<result> &results)
{
    const std::string head = "problem ";
    result *of = nullptr;
    for (std::size_t at = 0; at < message.size();) {
        const std::size_t end = (std::min)(message.find('\n', at), message.size());
        std::string line = message.substr(at, end - at);
        if (line.compare(0, head.size(), head) == 0) {
            const std::size_t k = std::strtoul(line.c_str() + head.size(), nullptr, 10), told = line.find(": ");
            of = k < results.size() ? &results[k] : nullptr;
            line.erase(0, told == std::string::npos ? 0 : told + 2);
        }
        if (of) of->message += (of->message.empty() ? "" : "\n") + line;
        at = end + 1;
    }
}

/// Gives each problem of a batch that is OK what it warns of: the message has the warnings of all problems, in the order of their bits.
inline void share_warnings(const std::string &message, std::vector<result> &results)
{
    std::uint32_t all = 0;
    for (const result &each : results) all |= static_cast<std::uint32_t>(each.report.warnings);
    std::size_t at = 0;
    for (std::uint32_t bit = 1; bit != 0 && bit <= all; bit <<= 1) {
        if ((all & bit) == 0) continue;
        const std::size_t end = (all >> 1) < bit ? message.size() : (std::min)(message.find("; ", at), message.size());
        for (result &each : results) {
            if ((static_cast<std::uint32_t>(each.report.warnings) & bit) == 0) continue;
            each.message += (each.message.empty() ? "" : "; ") + message.substr(at, end - at);
        }
        at = (std::min)(end + 2, message.size());
    }
}

} // namespace detail

} // namespace contact_normal

#endif // CONTACT_NORMAL_RESULT_HPP
