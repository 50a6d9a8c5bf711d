//! Networks run by onnxruntime, whose library is looked for when it is asked for.

use std::collections::HashSet;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::error::Error;
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use ort::LoadDynamicError;
pub use ort::environment::Environment;
use ort::ep::CUDA;
use ort::inputs;
use ort::logging::LogLevel;
use ort::session::builder::GraphOptimizationLevel;
use ort::session::{Session, SessionOutputs};
use ort::value::{DynValue, PrimitiveTensorElementType, TensorElementType, TensorRef, ValueType};
use prost::Message;

use super::guard::{guarded, line};
use super::pb;
use super::plan::{Element, Engine, Output, Pixels, Plan};

/// What recordings and the command line call it.
pub const NAME: &str = "ort";
/// The variable that says where the library is.
const LIBRARY: &str = "ORT_DYLIB_PATH";

/// The environment of onnxruntime, of which a process has one: the library is loaded when it is asked for first. The error
/// says what is missing, and how to get it.
pub fn environment() -> Result<Environment, String> {
    static READY: Mutex<Option<Environment>> = Mutex::new(None);
    let mut ready = READY.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(environment) = &*ready {
        return Ok(environment.clone());
    }
    let said = std::env::var_os(LIBRARY).filter(|path| !path.is_empty());
    let path = said.map_or_else(|| format!("{DLL_PREFIX}onnxruntime{DLL_SUFFIX}").into(), PathBuf::from);
    let environment = guarded(|| load(&path))?;
    Ok(ready.insert(environment).clone())
}

fn load(path: &Path) -> Result<Environment, String> {
    let builder = ort::init_from(path).map_err(|error| lacking(path, &error))?;
    let environment = builder.with_name("aeye").with_telemetry(false).build().map_err(reason)?;
    // What goes wrong comes back as an error as well.
    environment.set_log_level(LogLevel::Fatal);
    Ok(environment)
}

/// Why the library is of no use, and what to do about it.
fn lacking(path: &Path, error: &LoadDynamicError) -> String {
    let path = path.display();
    let what = match error {
        LoadDynamicError::Dlopen { error, .. } => {
            // The system's own words stand behind those of the loader.
            let why = error.source().map_or_else(|| format!("{path}: {error}"), ToString::to_string);
            format!("the library of onnxruntime cannot be loaded ({why})")
        }
        LoadDynamicError::BadVersion { version_str, .. } => {
            format!("{path} is of onnxruntime {version_str}, expected 1.{} or later", ort::MINOR_VERSION)
        }
        _ => format!("{path} is no library of onnxruntime"),
    };
    let named = format!("{DLL_PREFIX}onnxruntime{DLL_SUFFIX}");
    let what = line(&what);
    format!(
        "{what}; get it with `pip install onnxruntime` and set {LIBRARY} to the {named}* in the package's folder capi"
    )
}

fn reason<T>(error: ort::Error<T>) -> String {
    line(error.message())
}

/// Prepares a model for inputs of one shape; what its output is, is seen by a first run.
pub fn prepare(
    environment: &Environment,
    model: &pb::ModelProto,
    element: Element,
    shape: [usize; 4],
) -> Result<Engine, String> {
    let session = open(environment, &fixed(model, shape).encode_to_vec()).map_err(reason)?;
    let plan = Loaded { session: Mutex::new(session), shape };
    let count = shape.iter().product();
    let (output_shape, output) = match element {
        Element::Float => plan.run(Pixels::Float(&vec![0.0; count])),
        Element::Byte => plan.run(Pixels::Byte(&vec![0; count])),
    }?;
    let gives_ids = matches!(output, Output::Ids(_));
    Ok(Engine { plan: Arc::new(plan), takes_last: false, output_shape, is_moved: false, gives_ids })
}

/// On one thread, or on a GPU where the library and the machine have one for it.
fn open(environment: &Environment, model: &[u8]) -> ort::Result<Session> {
    let builder = Session::builder(environment)?.with_optimization_level(GraphOptimizationLevel::All)?;
    let builder = builder.with_intra_threads(1)?.with_inter_threads(1)?.with_parallel_execution(false)?;
    builder.with_execution_providers([CUDA::default().build()])?.commit_from_memory(model)
}

/// The model for inputs of one shape. Shapes that exporters noted for others contradict it, and weights that are listed
/// as inputs would count as values that change.
fn fixed(model: &pb::ModelProto, shape: [usize; 4]) -> pb::ModelProto {
    use pb::tensor_shape_proto::{Dimension, dimension::Value};
    let mut model = model.clone();
    let Some(graph) = &mut model.graph else { return model };
    let weights: HashSet<&str> = graph.initializer.iter().map(|tensor| tensor.name.as_str()).collect();
    graph.input.retain(|input| !weights.contains(input.name.as_str()));
    graph.value_info.clear();
    graph.output.iter_mut().for_each(|output| output.r#type = None);
    let kinds = graph.input.iter_mut().filter_map(|input| input.r#type.as_mut()?.value.as_mut());
    for pb::type_proto::Value::TensorType(tensor) in kinds {
        let dimension = |size| Dimension { value: Some(Value::DimValue(size as i64)), ..Default::default() };
        tensor.shape = Some(pb::TensorShapeProto { dim: shape.into_iter().map(dimension).collect() });
    }
    model
}

/// A session, which one thread uses at a time.
struct Loaded {
    session: Mutex<Session>,
    shape: [usize; 4],
}

impl Plan for Loaded {
    fn run(&self, pixels: Pixels<'_>) -> Result<(Vec<usize>, Output), String> {
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        let outputs = match pixels {
            Pixels::Float(values) => fed(&mut session, self.shape, values),
            Pixels::Byte(values) => fed(&mut session, self.shape, values),
        }
        .map_err(reason)?;
        taken(outputs.values().next().as_deref().ok_or("it gives nothing")?)
    }
}

fn fed<'a, T: PrimitiveTensorElementType + Clone + Debug + 'static>(
    session: &'a mut Session,
    shape: [usize; 4],
    values: &[T],
) -> ort::Result<SessionOutputs<'a>> {
    session.run(inputs![TensorRef::from_array_view((shape, values))?])
}

/// An output and its shape: fractions are scores, whole numbers are ids.
fn taken(value: &DynValue) -> Result<(Vec<usize>, Output), String> {
    let ValueType::Tensor { ty, shape, .. } = value.dtype() else { return Err("its output is no tensor".into()) };
    let shape = shape.iter().map(|&size| usize::try_from(size).unwrap_or(0)).collect();
    let output = match ty {
        TensorElementType::Float32 => Output::Scores(value.try_extract_tensor::<f32>().map_err(reason)?.1.to_vec()),
        TensorElementType::Int64 => ids::<i64>(value)?,
        TensorElementType::Int32 => ids::<i32>(value)?,
        TensorElementType::Int16 => ids::<i16>(value)?,
        TensorElementType::Int8 => ids::<i8>(value)?,
        TensorElementType::Uint32 => ids::<u32>(value)?,
        TensorElementType::Uint16 => ids::<u16>(value)?,
        TensorElementType::Uint8 => ids::<u8>(value)?,
        TensorElementType::Bool => ids::<bool>(value)?,
        other => return Err(format!("its output is of {other}, expected f32 or whole numbers")),
    };
    Ok((shape, output))
}

fn ids<T: PrimitiveTensorElementType + Copy + Into<i64>>(value: &DynValue) -> Result<Output, String> {
    let (_, values) = value.try_extract_tensor::<T>().map_err(reason)?;
    Ok(Output::Ids(values.iter().map(|&id| id.into()).collect()))
}
