"""The tests that use each dependency: all of them, and a few."""

from __future__ import annotations

Tests = dict[str, tuple[str, ...]]

# What uses each dependency, at every place where the package calls it. The other tests ask about the equations, the
# numbers and the project itself, for which `make test` has one environment, and `make verify` several kernels.
ALL = {
    "bokeh": ("explore",),
    "click": ("commands/test_command_line.py",),
    "contourpy": ("stability/test_stability_map.py",),
    "control": ("model/test_inputs_outputs.py",),
    "dask": ("study/test_study_distributed.py",),
    "filelock": ("study/test_study_resume.py",),
    "fluids": ("rotor/test_atmosphere.py",),
    "h5py": ("nastran/test_other_results.py",),
    "jinja2": ("report",),
    "matplotlib": ("plots",),
    "netcdf4": ("files/test_output_file.py",),
    "numpy": ("stability/test_sweep.py", "model/test_frequency_response.py"),
    "openmdao": ("exchange/test_openmdao.py",),
    "pillow": ("plots/test_plots_of_motion.py",),
    "pint": ("units", "deck/test_inputs_with_units.py"),
    "proprotor-equations": ("derive/test_equations_alone.py",),
    "psutil": ("project/test_needs.py::test_a_limit_of_a_control_group_counts",),
    "pydantic": ("deck/test_deck.py",),
    "python-docx": ("report/test_word.py",),
    "rich": ("tables",),
    "salib": ("study/test_sampling.py", "study/test_uncertainty.py"),
    "scipy": ("support/test_matrix_market.py", "exchange/test_matlab_file.py"),
    "tornado": ("explore",),
    "typst": ("report",),
    "xarray": ("stability/test_airspeeds.py", "study/test_mode_damping.py"),
}

# A few tests of each dependency, which call what the package uses of it. What is left out asks again, with other
# inputs, for numbers and messages that are the package's own.
_EXPLORE, _COMMANDS, _RESUME = (
    "explore/test_explore.py",
    "commands/test_command_line.py",
    "study/test_study_resume.py",
)
SHORT = ALL | {
    "bokeh": (
        f"{_EXPLORE}::test_moving_a_slider_moves_what_is_drawn_and_told",
        f"{_EXPLORE}::test_a_value_is_set_exactly",
        f"{_EXPLORE}::test_a_switch_of_the_model_is_that_of_the_engine",
    ),
    "click": (
        f"{_COMMANDS}::test_table_has_a_row_for_each_airspeed_and_the_support_modes",
        f"{_COMMANDS}::test_table_states_convention_inputs_and_calibration",
        f"{_COMMANDS}::test_csv_is_the_sweep",
        f"{_COMMANDS}::test_an_unusable_input_is_told_without_a_traceback",
        f"{_COMMANDS}::test_help_has_exit_codes",
    ),
    "contourpy": (
        "stability/test_stability_map.py::test_a_circle_is_one_closed_line",
        "stability/test_stability_map.py::test_the_boundary_is_that_found_along_airspeed",
    ),
    "control": (
        "model/test_inputs_outputs.py::test_python_control_has_the_same_system",
        "model/test_inputs_outputs.py::test_python_control_takes_one_point",
    ),
    "dask": (
        "study/test_study_distributed.py::test_a_study_begun_on_a_cluster_may_end_here",
        "study/test_study_distributed.py::test_an_error_on_the_cluster_is_raised_here",
    ),
    "filelock": (
        f"{_RESUME}::test_two_studies_do_not_share_a_folder",
        f"{_RESUME}::test_the_hold_of_a_study_that_was_killed_holds_nobody",
        f"{_RESUME}::test_batches_outlive_a_change_of_what_only_draws",
    ),
    "h5py": (
        "nastran/test_other_results.py::test_hdf5",
        "nastran/test_other_results.py::test_hdf5_with_two_subcases_and_complex_vectors_beside",
        "nastran/test_other_results.py::test_hdf5_without_eigenvalues_needs_the_masses",
        "nastran/test_other_results.py::test_results_are_saved_after_an_hdf5_file_was_opened",
    ),
    "jinja2": (
        "report/test_report.py::test_the_tables_of_modes_are_those_of_sweep",
        "report/test_report.py::test_a_hostile_title_is_text",
    ),
    "matplotlib": (
        "plots/test_plots.py::test_lines_are_the_numbers_of_the_sweep",
        "plots/test_plots.py::test_labels_do_not_overlap_and_stay_in_the_figure",
        "plots/test_accessor.py::test_every_plot_that_it_offers_can_be_drawn",
        "plots/test_plots_of_motion.py::test_a_shape_is_drawn_over_the_trim_state_in_radii",
    ),
    "netcdf4": ("files/test_output_file.py::test_what_is_written_can_be_read",),
    "openmdao": (
        "exchange/test_openmdao.py::test_flutter_speed",
        "exchange/test_openmdao.py::test_damping_at_speeds",
        "exchange/test_openmdao.py::test_setups_that_mean_nothing",
    ),
    "pillow": ("plots/test_plots_of_motion.py::test_an_animation_is_a_gif_of_one_cycle_that_repeats",),
    "proprotor-equations": ("derive/test_equations_alone.py::test_many_rotors_at_once",),
    "pydantic": (
        "deck/test_deck.py::test_all_mistakes_are_told_at_once",
        "deck/test_deck.py::test_a_mistake_is_told_in_one_line",
        "deck/test_deck.py::test_a_deck_that_cannot_be_found",
    ),
    "python-docx": ("report/test_word.py::test_the_tables_are_those_of_the_document",),
    "rich": (
        "tables/test_sweep_table.py",
        f"{_COMMANDS}::test_what_takes_long_is_announced_on_a_terminal",
    ),
    "salib": (
        "study/test_uncertainty.py::test_indices_are_those_of_a_study_from_a_file",
        "study/test_uncertainty.py::test_base_samples_with_a_failed_design_are_left_out",
    ),
    "scipy": (
        "support/test_matrix_market.py",
        "exchange/test_matlab_file.py::test_a_model",
        "study/test_sampling.py",
    ),
    "tornado": (
        f"{_EXPLORE}::test_the_server_answers_this_machine_alone",
        f"{_EXPLORE}::test_a_port_that_is_taken_is_one_message",
    ),
    "typst": ("report/test_report.py::test_the_pdf_has_the_same_numbers",),
    "xarray": (
        "stability/test_airspeeds.py::test_ranges_lists_quantities_and_labelled_arrays",
        "plots/test_accessor.py::test_a_result_knows_what_it_is_and_keeps_knowing_it_in_a_file",
        "tables/test_study_table.py::test_flutter_speeds_are_those_of_the_designs_alone",
    ),
}
