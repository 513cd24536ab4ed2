// contact-normal 0.2.0: the elastic normal contact problem by full multigrid, for C++17. Header-only, on contact_normal.h.
//
// #include <contact_normal.hpp>
// namespace cn = contact_normal;
// cn::scene scene({mx, my, dx, dy}, {82000.0, 0.28});               // both bodies; or two of them
// scene.undeformed_distance(h).force(1000.0);                       // h: a std::vector<double> of my * mx, x fastest
// cn::result found = cn::solve(scene);                              // throws cn::error if the scene is refused
// if (!found) std::cerr << found.message;                           // stopped early: found.status > 0
// found.pressure, found.contact, found.report.normal.approach, found.ledger
//
// A scene does not copy arrays: they must live until the solve is over, and the compiler refuses temporaries. contact_normal.h
// says what each member and each status means. `solver` is a handle for many solves on one grid; one thread at a time may use it.
// A loop that solves many times calls `solver.solve_into(scene, found)`, which writes what `found` asks for: all but the ledger, or
// as `cn::result found(cn::fields::pressure | cn::fields::contact)` says.
//
// The parts, contact_normal_....hpp, stand beside this file; each can be included alone.
#ifndef CONTACT_NORMAL_HPP
#define CONTACT_NORMAL_HPP

#include <contact_normal_accuracy.hpp>
#include <contact_normal_arrays.hpp>
#include <contact_normal_adhesion.hpp>
#include <contact_normal_friction.hpp>
#include <contact_normal_library.hpp>
#include <contact_normal_options.hpp>
#include <contact_normal_result.hpp>
#include <contact_normal_scene.hpp>
#include <contact_normal_solver.hpp>
#include <contact_normal_stress.hpp>
#include <contact_normal_tangential.hpp>
#include <contact_normal_visco.hpp>

#endif // CONTACT_NORMAL_HPP
