import 'uplot/dist/uPlot.min.css';
import '../chart/chart.css';
import './style/page.css';
import './style/forms.css';
import './style/views.css';
import { mount } from 'svelte';
import App from './App.svelte';
import { session } from './model/session.svelte';

const target = document.getElementById('app');
if (target) {
  mount(App, { target });
  void session.start();
}
