//! The integration tests, one binary. Each module tests one promise to the user.

mod circles;
mod classes;
mod datasets;
mod lab;
mod real_maps;
mod render_frame;
mod render_oracle;
mod replay_budget;
mod replay_case;
mod replay_damage;
mod replay_verify;
mod rig_bots;
mod rig_campaign;
mod rig_cli;
mod rig_compare;
mod rig_criticality;
mod rig_experiment;
mod rig_export;
mod rig_learning;
mod rig_pipeline;
mod rig_redrive;
mod rig_rerender;
mod rig_statistics;
mod rig_study;
mod rig_units;
mod tidy;
