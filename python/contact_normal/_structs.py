"""The structs and callbacks of include/contact_normal.h for ctypes. Made from that; do not edit."""

import ctypes
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_double, c_int32, c_int64, c_void_p


class Coating(ctypes.Structure):
    """contact_normal_coating."""

    _fields_ = [
        ("struct_size", c_int64),
        ("thickness", c_double),
        ("shear_modulus", c_double),
        ("poisson_ratio", c_double),
    ]


class Influence(ctypes.Structure):
    """contact_normal_influence."""

    _fields_ = [
        ("struct_size", c_int64),
        ("cx", c_int32),
        ("cy", c_int32),
        ("coefficients", POINTER(c_double)),
        ("scale", c_double),
    ]


class Layer(ctypes.Structure):
    """contact_normal_layer."""

    _fields_ = [
        ("struct_size", c_int64),
        ("compliance", c_double),
        ("compliances", POINTER(c_double)),
    ]


class PressureLimit(ctypes.Structure):
    """contact_normal_pressure_limit."""

    _fields_ = [
        ("struct_size", c_int64),
        ("limit", c_double),
        ("limits", POINTER(c_double)),
    ]


class Period(ctypes.Structure):
    """contact_normal_period."""

    _fields_ = [
        ("struct_size", c_int64),
        ("x", c_int32),
        ("y", c_int32),
    ]


class Patches(ctypes.Structure):
    """contact_normal_patches."""

    _fields_ = [
        ("struct_size", c_int64),
        ("count", c_int32),
        ("reserved", c_int32),
        ("patch", POINTER(c_int32)),
        ("factors", POINTER(c_double)),
    ]


class RowTables(ctypes.Structure):
    """contact_normal_row_tables."""

    _fields_ = [
        ("struct_size", c_int64),
        ("cx", c_int32),
        ("rows", c_int32),
        ("coefficients", POINTER(c_double)),
        ("scale", c_double),
    ]


class Friction(ctypes.Structure):
    """contact_normal_friction."""

    _fields_ = [
        ("struct_size", c_int64),
        ("coefficient", c_double),
        ("coefficients", POINTER(c_double)),
        ("motion", c_int32),
        ("continues", c_int32),
        ("prescribed", c_int32 * 2),
        ("creepage", c_double * 2),
        ("spin", c_double),
        ("spin_centre", c_double * 2),
        ("force", c_double * 2),
        ("rolling_distance", c_double),
        ("rolling_direction", c_double),
        ("spin_offset", c_double),
        ("previous_traction", POINTER(c_double) * 2),
        ("rigid_slip", POINTER(c_double) * 2),
        ("influence", POINTER(Influence) * 3),
        ("influence_cross", POINTER(Influence) * 2),
        ("sensitivities", c_int32),
        ("reserved", c_int32),
        ("initial_traction", POINTER(c_double) * 2),
        ("compliance", c_double),
        ("compliances", POINTER(c_double)),
        ("creepage_weight", POINTER(c_double) * 2),
        ("row_tables", POINTER(RowTables) * 3),
        ("law", c_int32),
        ("reserved_for_law", c_int32),
        ("kinetic", c_double),
        ("falling", c_double * 2),
        ("half_speed", c_double * 2),
        ("speed", c_double),
        ("time_step", c_double),
        ("memory_distance", c_double),
        ("memory_speed", c_double),
        ("yield_limit", c_double),
        ("hardening", c_double),
        ("previous_coefficient", POINTER(c_double)),
        ("previous_yield_limit", POINTER(c_double)),
        ("branch", c_int32),
        ("reserved_for_branch", c_int32),
    ]


class Adhesion(ctypes.Structure):
    """contact_normal_adhesion."""

    _fields_ = [
        ("struct_size", c_int64),
        ("law", c_int32),
        ("start", c_int32),
        ("work_of_adhesion", c_double),
        ("works_of_adhesion", POINTER(c_double)),
        ("range", c_double),
        ("smear", c_double),
        ("stiffness", c_int32),
        ("stability", c_int32),
        ("shear_strength", c_double),
    ]


class Visco(ctypes.Structure):
    """contact_normal_visco."""

    _fields_ = [
        ("struct_size", c_int64),
        ("branches", c_int32 * 2),
        ("modulus", POINTER(c_double) * 2),
        ("time", POINTER(c_double) * 2),
        ("time_step", c_double),
        ("form", c_int32),
        ("continues", c_int32),
    ]


class Scene(ctypes.Structure):
    """contact_normal_scene."""

    _fields_ = [
        ("struct_size", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("dx", c_double),
        ("dy", c_double),
        ("undeformed_distance", POINTER(c_double)),
        ("shear_modulus", c_double * 2),
        ("poisson_ratio", c_double * 2),
        ("load", c_int32),
        ("reserved", c_int32),
        ("approach", c_double),
        ("force", c_double),
        ("influence", POINTER(Influence)),
        ("layer", POINTER(Layer)),
        ("pressure_limit", POINTER(PressureLimit)),
        ("period", POINTER(Period)),
        ("patches", POINTER(Patches)),
        ("row_tables", POINTER(RowTables)),
        ("coating", POINTER(Coating) * 2),
        ("friction", POINTER(Friction)),
        ("adhesion", POINTER(Adhesion)),
        ("visco", POINTER(Visco)),
    ]


class Progress(ctypes.Structure):
    """contact_normal_progress."""

    _fields_ = [
        ("struct_size", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("cycles", c_int64),
        ("active_set_changes", c_int64),
        ("seconds", c_double),
        ("work_units", c_double),
        ("update", c_double),
        ("residual", c_double),
    ]


class Cycle(ctypes.Structure):
    """contact_normal_cycle."""

    _fields_ = [
        ("struct_size", c_int64),
        ("smoother", c_int32),
        ("pre_sweeps", c_int32),
        ("post_sweeps", c_int32),
        ("coarsest", c_int32),
        ("relaxation", c_double),
    ]


ProgressCallback = CFUNCTYPE(c_int32, POINTER(Progress), c_void_p)


class Options(ctypes.Structure):
    """contact_normal_options."""

    _fields_ = [
        ("struct_size", c_int64),
        ("method", c_int32),
        ("active_set", c_int32),
        ("initial_guess", c_int32),
        ("criterion", c_int32),
        ("tolerance", c_double),
        ("error_ratio", c_double),
        ("max_cycles", c_int32),
        ("threads", c_int32),
        ("precision", c_int32),
        ("reserved", c_int32),
        ("progress", ProgressCallback),
        ("user", c_void_p),
        ("cycle", POINTER(Cycle)),
        ("max_seconds", c_double),
        ("stop", POINTER(c_int32)),
        ("dump", c_void_p),
        ("neglect_below", c_double),
    ]


class Fields(ctypes.Structure):
    """contact_normal_fields."""

    _fields_ = [
        ("struct_size", c_int64),
        ("pressure", POINTER(c_double)),
        ("deformed_distance", POINTER(c_double)),
        ("displacement", POINTER(c_double)),
        ("contact", POINTER(c_int32)),
        ("traction", POINTER(c_double) * 2),
        ("slip", POINTER(c_double) * 2),
        ("stick_slip", POINTER(c_int32)),
        ("contact_pressure", POINTER(c_double)),
        ("attraction", POINTER(c_double)),
        ("friction_coefficient", POINTER(c_double)),
        ("yield_limit", POINTER(c_double)),
    ]


class LedgerRow(ctypes.Structure):
    """contact_normal_ledger_row."""

    _fields_ = [
        ("struct_size", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("cycles", c_int64),
        ("seconds", c_double),
        ("work_units", c_double),
        ("residual", c_double),
        ("approach", c_double),
        ("force", c_double),
        ("max_pressure", c_double),
        ("contact_area", c_double),
        ("corrected_area", c_double),
        ("error_force", c_double),
        ("error_max_pressure", c_double),
        ("error_contact_area", c_double),
        ("error_corrected_area", c_double),
        ("error_pressure", c_double),
        ("contact_count", c_int64),
        ("untrusted", c_int32),
        ("reserved", c_int32),
    ]


class ReportNormal(ctypes.Structure):
    """contact_normal_report_normal."""

    _fields_ = [
        ("approach", c_double),
        ("force", c_double),
        ("max_pressure", c_double),
        ("min_pressure", c_double),
        ("contact_area", c_double),
        ("corrected_area", c_double),
        ("contact_count", c_int64),
        ("edge_count", c_int64),
        ("tolerance", c_double),
        ("residual", c_double),
        ("violation", c_double),
        ("complementarity", c_double),
        ("update", c_double),
        ("reserved", c_double * 8),
    ]


class ReportTangential(ctypes.Structure):
    """contact_normal_report_tangential."""

    _fields_ = [
        ("force", c_double * 2),
        ("moment", c_double),
        ("creepage", c_double * 2),
        ("residual", c_double),
        ("gap", c_double),
        ("stick_count", c_int64),
        ("slip_count", c_int64),
        ("sensitivities", c_double * 9),
        ("update", c_double),
        ("law_slope", c_double),
        ("reserved", c_double * 6),
    ]


class ReportAccuracy(ctypes.Structure):
    """contact_normal_report_accuracy."""

    _fields_ = [
        ("error_force", c_double),
        ("error_max_pressure", c_double),
        ("error_contact_area", c_double),
        ("error_corrected_area", c_double),
        ("error_pressure", c_double),
        ("error_tangential", c_double * 2),
        ("untrusted", c_int32),
        ("limited_by", c_int32),
        ("halved_seconds", c_double),
        ("halved_error_force", c_double),
        ("neglected", c_int64),
        ("neglected_error", c_double),
        ("reserved", c_double * 6),
    ]


class ReportStatistics(ctypes.Structure):
    """contact_normal_report_statistics."""

    _fields_ = [
        ("cycles", c_int64),
        ("active_set_steps", c_int64),
        ("active_set_changes", c_int64),
        ("matrix_products", c_int64),
        ("work_units", c_double),
        ("tangential_products", c_double),
        ("setup_seconds", c_double),
        ("solve_seconds", c_double),
        ("tangential_seconds", c_double),
        ("bytes", c_int64),
        ("reserved", c_double * 8),
    ]


class ReportAdhesion(ctypes.Structure):
    """contact_normal_report_adhesion."""

    _fields_ = [
        ("repulsive_force", c_double),
        ("adhesive_force", c_double),
        ("elastic_energy", c_double),
        ("adhesive_energy", c_double),
        ("law_residual", c_double),
        ("range", c_double),
        ("resolution", c_double),
        ("border_share", c_double),
        ("stiffness", c_double),
        ("stability", c_double),
        ("jumped", c_int32),
        ("reserved_integer", c_int32),
        ("reserved", c_double * 5),
    ]


class ReportVisco(ctypes.Structure):
    """contact_normal_report_visco."""

    _fields_ = [
        ("time", c_double),
        ("step_error", c_double),
        ("time_error", c_double),
        ("compliance", c_double),
        ("reserved", c_double * 4),
    ]


class Report(ctypes.Structure):
    """contact_normal_report."""

    _fields_ = [
        ("struct_size", c_int64),
        ("ledger_rows", c_int64),
        ("ledger_capacity", c_int64),
        ("ledger", POINTER(LedgerRow)),
        ("warnings", c_int32),
        ("reserved", c_int32),
        ("normal", ReportNormal),
        ("tangential", ReportTangential),
        ("accuracy", ReportAccuracy),
        ("statistics", ReportStatistics),
        ("adhesion", ReportAdhesion),
        ("visco", ReportVisco),
    ]


class SolverInfo(ctypes.Structure):
    """contact_normal_solver_info."""

    _fields_ = [
        ("struct_size", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("dx", c_double),
        ("dy", c_double),
        ("threads", c_int32),
        ("has_result", c_int32),
        ("bytes", c_int64),
    ]


class FrictionResults(ctypes.Structure):
    """contact_normal_friction_results."""

    _fields_ = [
        ("struct_size", c_int64),
        ("force", POINTER(c_double)),
        ("moment", POINTER(c_double)),
        ("creepage", POINTER(c_double)),
        ("residual", POINTER(c_double)),
        ("gap", POINTER(c_double)),
        ("products", POINTER(c_double)),
        ("stick_count", POINTER(c_int64)),
        ("slip_count", POINTER(c_int64)),
        ("status", POINTER(c_int32)),
        ("traction", POINTER(c_double)),
        ("slip", POINTER(c_double)),
        ("stick_slip", POINTER(c_int32)),
        ("friction_coefficient", POINTER(c_double)),
        ("yield_limit", POINTER(c_double)),
    ]


SurfaceCallback = CFUNCTYPE(c_int32, c_int32, c_int32, c_double, c_double, POINTER(c_double), c_void_p)


class Accuracy(ctypes.Structure):
    """contact_normal_accuracy."""

    _fields_ = [
        ("struct_size", c_int64),
        ("target", c_double),
        ("max_seconds", c_double),
        ("max_bytes", c_int64),
        ("max_elements", c_int64),
        ("surface", SurfaceCallback),
        ("user", c_void_p),
        ("mx", c_int32),
        ("my", c_int32),
        ("dx", c_double),
        ("dy", c_double),
        ("reached", c_double),
        ("seconds", c_double),
        ("max_pressure_target", c_double),
        ("contact_area_target", c_double),
        ("mean_gap_target", c_double),
        ("stiffness_target", c_double),
        ("tangential_force_target", c_double),
        ("creepage_target", c_double),
        ("spin_moment_target", c_double),
        ("stick_area_target", c_double),
        ("max_von_mises_target", c_double),
        ("von_mises_depth_target", c_double),
        ("max_shear_target", c_double),
    ]


class Price(ctypes.Structure):
    """contact_normal_price."""

    _fields_ = [
        ("struct_size", c_int64),
        ("target", c_double),
        ("error", c_double),
        ("tolerance", c_double),
        ("seconds", c_double),
        ("seconds_one_thread", c_double),
        ("bytes", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("dx", c_double),
        ("dy", c_double),
        ("obstacle", c_int32),
        ("reserved", c_int32),
        ("time_error", c_double),
        ("work_units", c_double),
    ]


class QuantityRow(ctypes.Structure):
    """contact_normal_quantity_row."""

    _fields_ = [
        ("struct_size", c_int64),
        ("quantity", c_int32),
        ("lack", c_int32),
        ("mx", c_int32),
        ("my", c_int32),
        ("value", c_double),
        ("error", c_double),
        ("seconds", c_double),
        ("work_units", c_double),
    ]


class EffectsRow(ctypes.Structure):
    """contact_normal_effects_row."""

    _fields_ = [
        ("struct_size", c_int64),
        ("omitted", c_int32),
        ("also_omitted", c_int32),
        ("quantity", c_int32),
        ("verdict", c_int32),
        ("lack", c_int32),
        ("reserved", c_int32),
        ("value", c_double),
        ("change", c_double),
        ("change_error", c_double),
        ("seconds", c_double),
        ("seconds_without", c_double),
        ("bytes", c_double),
        ("bytes_without", c_double),
    ]


class HertzSolution(ctypes.Structure):
    """contact_normal_hertz_solution."""

    _fields_ = [
        ("struct_size", c_int64),
        ("semi_axis_x", c_double),
        ("semi_axis_y", c_double),
        ("max_pressure", c_double),
        ("approach", c_double),
        ("force", c_double),
        ("area", c_double),
    ]


class StressMaximum(ctypes.Structure):
    """contact_normal_stress_maximum."""

    _fields_ = [
        ("struct_size", c_int64),
        ("value", c_double),
        ("x", c_double),
        ("y", c_double),
        ("z", c_double),
        ("ix", c_int32),
        ("iy", c_int32),
        ("depth", c_int32),
        ("reserved", c_int32),
    ]


class StressOutputs(ctypes.Structure):
    """contact_normal_stress_outputs."""

    _fields_ = [
        ("struct_size", c_int64),
        ("stress", POINTER(c_double) * 6),
        ("von_mises", POINTER(c_double)),
        ("maximum_shear", POINTER(c_double)),
        ("principal", POINTER(c_double) * 3),
        ("directions", POINTER(c_double) * 3),
        ("largest_von_mises", POINTER(StressMaximum)),
        ("largest_shear", POINTER(StressMaximum)),
    ]


class Heat(ctypes.Structure):
    """contact_normal_heat."""

    _fields_ = [
        ("struct_size", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("dx", c_double),
        ("dy", c_double),
        ("heat_flux", POINTER(c_double)),
        ("conductivity", c_double * 2),
        ("diffusivity", c_double * 2),
        ("speed", c_double * 2),
        ("share", c_double),
        ("threads", c_int32),
        ("reserved", c_int32),
    ]


class Flash(ctypes.Structure):
    """contact_normal_flash."""

    _fields_ = [
        ("struct_size", c_int64),
        ("share", c_double),
        ("largest", c_double * 2),
        ("x", c_double * 2),
        ("y", c_double * 2),
    ]


class Wear(ctypes.Structure):
    """contact_normal_wear."""

    _fields_ = [
        ("struct_size", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("dx", c_double),
        ("dy", c_double),
        ("traction", POINTER(c_double) * 2),
        ("slip", POINTER(c_double) * 2),
        ("pressure", POINTER(c_double)),
        ("coefficient", c_double),
        ("coefficients", POINTER(c_double)),
        ("hardness", c_double),
        ("steps", c_double),
        ("rolling_distance", c_double),
    ]


class Worn(ctypes.Structure):
    """contact_normal_worn."""

    _fields_ = [
        ("struct_size", c_int64),
        ("work", c_double),
        ("volume", c_double),
        ("largest_depth", c_double),
        ("x", c_double),
        ("y", c_double),
    ]


LogCallback = CFUNCTYPE(None, c_int32, c_char_p, c_void_p)


def names(kind: type[ctypes.Structure]) -> list[str]:
    """The members of a struct."""
    return [field[0] for field in kind._fields_]


# The structs that have an _init, and the kind of each.
KINDS: dict[str, tuple[int, type[ctypes.Structure]]] = {
    "scene": (1, Scene),
    "options": (2, Options),
    "fields": (3, Fields),
    "report": (4, Report),
    "accuracy": (5, Accuracy),
    "influence": (6, Influence),
    "row_tables": (7, RowTables),
    "layer": (8, Layer),
    "pressure_limit": (9, PressureLimit),
    "period": (10, Period),
    "patches": (11, Patches),
    "coating": (12, Coating),
    "friction": (13, Friction),
    "friction_results": (14, FrictionResults),
    "stress_outputs": (15, StressOutputs),
    "stress_maximum": (16, StressMaximum),
    "ledger_row": (17, LedgerRow),
    "price": (18, Price),
    "hertz_solution": (19, HertzSolution),
    "cycle": (20, Cycle),
    "solver_info": (21, SolverInfo),
    "quantity_row": (22, QuantityRow),
    "effects_row": (23, EffectsRow),
    "adhesion": (24, Adhesion),
    "visco": (25, Visco),
    "heat": (26, Heat),
    "flash": (27, Flash),
    "wear": (28, Wear),
    "worn": (29, Worn),
}
